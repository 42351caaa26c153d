#include "sim/lsystem/rule_parser.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace sunfleck::lsystem {

RuleParser::RuleParser(Cursor cursor, const SymbolTable& symbols,
                       const std::map<std::string, double>& constants, const SystemNames& systems)
    : cursor_(cursor), symbols_(symbols), systems_(systems) {
  scope_.constants = &constants;
}

std::uint16_t RuleParser::parse_symbol() {
  cursor_.skip_blanks();
  const std::uint16_t symbol = symbols_.longest_match(cursor_.text.substr(cursor_.position));
  if (symbol == SymbolTable::npos)
    cursor_.fail("undeclared symbol", "a turtle command or a name declared by `symbols:`");
  cursor_.position += symbols_.at(symbol).name.size();
  return symbol;
}

void RuleParser::check_arity(std::uint16_t symbol, std::size_t count) {
  const int arity = symbols_.at(symbol).arity;
  if (arity != kAnyArity && count != static_cast<std::size_t>(arity))
    cursor_.fail("module '" + symbols_.at(symbol).name + "' with " + std::to_string(count) + " parameters",
                 "the " + std::to_string(arity) + " it was declared with");
}

std::uint16_t RuleParser::add_slot(const std::string& name) {
  if (name.empty()) cursor_.fail("expected a name", "a name such as x or age");
  if (scope_.slots.size() == kMaxSlots) cursor_.fail("too many names in one rule", "at most 64");
  scope_.slots.push_back(name);
  return static_cast<std::uint16_t>(scope_.slots.size() - 1);
}

ModulePattern RuleParser::parse_pattern() {
  ModulePattern pattern{parse_symbol(), 0, static_cast<std::uint16_t>(scope_.slots.size())};
  if (cursor_.peek() == '(') {
    ++cursor_.position;
    do {
      const std::string name = cursor_.identifier();
      if (std::count(scope_.slots.begin(), scope_.slots.end(), name) != 0)
        cursor_.fail("the name '" + name + "' stands for two parameters", "a name of its own for each");
      add_slot(name);
      ++pattern.arity;
    } while (cursor_.accept(","));
    cursor_.expect(")", "close the parameters");
  }
  check_arity(pattern.symbol, pattern.arity);
  return pattern;
}

bool RuleParser::at_pattern_end() {
  cursor_.skip_blanks();
  const char c = cursor_.peek();
  return c == '\0' || c == '<' || c == '>' || c == ':' || cursor_.text.substr(cursor_.position, 3) == "-->";
}

std::vector<ModulePattern> RuleParser::parse_patterns() {
  std::vector<ModulePattern> patterns;
  while (!at_pattern_end()) patterns.push_back(parse_pattern());
  return patterns;
}

void RuleParser::parse_left_hand_side(Rule& rule) {
  std::vector<ModulePattern> first = parse_patterns();
  if (cursor_.accept("<<")) {
    rule.new_left = std::exchange(first, parse_patterns());
  } else if (cursor_.accept("<")) {
    rule.left = std::exchange(first, parse_patterns());
  }
  if (first.size() != 1)
    cursor_.fail("a rule that rewrites " + std::to_string(first.size()) + " modules", "exactly one module");
  rule.predecessor = first.front();
  if (cursor_.accept(">>"))
    rule.new_right = parse_patterns();
  else if (cursor_.accept(">"))
    rule.right = parse_patterns();
}

std::vector<Assignment> RuleParser::parse_assignments() {
  std::vector<Assignment> assignments;
  while (!cursor_.accept("}")) {
    const std::string name = cursor_.identifier();
    cursor_.expect("=", "{name = expression; ...}");
    Program value = parse_expression(cursor_, scope_);
    const auto known = std::find(scope_.slots.begin(), scope_.slots.end(), name);
    const auto slot = known != scope_.slots.end() ? static_cast<std::uint16_t>(known - scope_.slots.begin())
                                                  : add_slot(name);
    assignments.push_back({slot, std::move(value)});
    if (!cursor_.accept(";")) {
      cursor_.expect("}", "end an assignment with ';' and the block with '}'");
      break;
    }
  }
  return assignments;
}

// `: {before} until age when condition {after}`, every part optional.
void RuleParser::parse_guards(Rule& rule, RuleKind kind) {
  if (!cursor_.accept(":")) return;
  if (cursor_.accept("{")) rule.before = parse_assignments();
  if (kind == RuleKind::kTimed) {
    cursor_.expect("until", "a timed rule states its terminal age: `until 3`");
    rule.terminal_age = parse_expression(cursor_, scope_);
    if (cursor_.accept("when")) rule.condition = parse_expression(cursor_, scope_);
  } else if (!cursor_.accept("*")) {
    cursor_.skip_blanks();
    if (cursor_.peek() != '{' && cursor_.text.substr(cursor_.position, 3) != "-->")
      rule.condition = parse_expression(cursor_, scope_);
  }
  if (cursor_.accept("{")) rule.after = parse_assignments();
}

void RuleParser::parse_system_name(Rule& rule) {
  cursor_.expect("(", "@begin(name of a system)");
  const std::string name = cursor_.identifier();
  const auto system = std::find(systems_.begin(), systems_.end(), name);
  if (system == systems_.end()) cursor_.fail("no system '" + name + "'", "a name from an `lsystem:` line");
  cursor_.expect(")", "@begin(name of a system)");
  rule.programs.push_back({{Op::kConstant, 0, static_cast<double>(system - systems_.begin())}});
}

void RuleParser::parse_parameters(Rule& rule, SuccessorModule& module) {
  if (symbols_.at(module.symbol).op == TurtleOp::kSystemBegin) {
    parse_system_name(rule);
    module.parameter_count = 1;
    return;
  }
  if (cursor_.peek() == '(') {
    ++cursor_.position;
    do {
      rule.programs.push_back(parse_expression(cursor_, scope_));
      ++module.parameter_count;
    } while (cursor_.accept(","));
    cursor_.expect(")", "close the parameters");
  }
  if (module.parameter_count > kMaxParameters) cursor_.fail("too many parameters", "at most 32");
  check_arity(module.symbol, module.parameter_count);
}

void RuleParser::parse_successor(Rule& rule) {
  int depth = 0;
  for (cursor_.skip_blanks(); !cursor_.at_end() && cursor_.peek() != ':'; cursor_.skip_blanks()) {
    SuccessorModule module{parse_symbol(), 0, static_cast<std::uint32_t>(rule.programs.size())};
    parse_parameters(rule, module);
    rule.successor.push_back(module);
    if (symbols_.at(module.symbol).op == TurtleOp::kPush) ++depth;
    if (symbols_.at(module.symbol).op == TurtleOp::kPop && --depth < 0)
      cursor_.fail("unbalanced brackets: ']' without '['", "as many '[' as ']'");
  }
  if (depth != 0) cursor_.fail("unbalanced brackets: '[' is never closed", "as many '[' as ']'");
}

void RuleParser::check_rule(const Rule& rule, RuleKind kind) {
  const TurtleOp op = symbols_.at(rule.predecessor.symbol).op;
  if (op == TurtleOp::kPush || op == TurtleOp::kPop)
    cursor_.fail("a rule that rewrites a bracket", "rules for other modules");
  const auto bracket = [&](const ModulePattern& p) {
    return symbols_.at(p.symbol).op == TurtleOp::kPush || symbols_.at(p.symbol).op == TurtleOp::kPop;
  };
  if (std::any_of(rule.left.begin(), rule.left.end(), bracket) ||
      std::any_of(rule.new_left.begin(), rule.new_left.end(), bracket))
    cursor_.fail("a bracket in a left context", "modules of the path to the root only");
  if (kind != RuleKind::kProduction && rule.has_context())
    cursor_.fail("a context in a timed, decomposition or interpretation rule", "a rule without < and >");
  if (!rule.new_left.empty() && !rule.new_right.empty())
    cursor_.fail("a rule with both << and >>", "one of them: a string is produced in one direction");
}

// A weight that is a constant is checked here, so that also rules that never fit are right; others when used.
void RuleParser::parse_weight(Rule& rule) {
  rule.weight = parse_expression(cursor_, scope_);
  if (rule.weight.size() != 1 || rule.weight.front().op != Op::kConstant || rule.weight.front().value >= 0)
    return;
  cursor_.fail("a negative weight (or not a number)", "a chance in proportion to others: 0 or more");
}

Rule RuleParser::parse_rule(int line, RuleKind kind) {
  Rule rule;
  rule.line = line;
  rule.text = std::string(cursor_.text);
  parse_left_hand_side(rule);
  parse_guards(rule, kind);
  if (kind == RuleKind::kTimed && rule.terminal_age.empty())
    cursor_.fail("a timed rule without a terminal age", "`predecessor : until age --> successor`");
  cursor_.expect("-->", "predecessor : condition --> successor");
  parse_successor(rule);
  if (cursor_.accept(":")) parse_weight(rule);
  cursor_.skip_blanks();
  if (!cursor_.at_end()) cursor_.fail("text after the end of the rule", "nothing more");
  check_rule(rule, kind);
  return rule;
}

}  // namespace sunfleck::lsystem
