#include "sim/lsystem/grammar_parser.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "sim/base/error.h"
#include "sim/lsystem/rule_table.h"

namespace sunfleck::lsystem {
namespace {

constexpr std::size_t kMostSymbols = 60'000;  // they are numbered by 16 bits

// The word (or words) before the first ':' when the statement is no rule; empty otherwise.
std::string keyword_of(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (text.find("-->") != text.npos || colon == text.npos) return {};
  return text.substr(0, text.find_last_not_of(' ', colon - 1) + 1);
}

constexpr const char* kKeywords =
    "one of symbols timed draw move organs ignore consider, angle step width, width increment, elasticity, "
    "tropism, steps, maximum depth, axiom, lsystem, endlsystem, production, group, schedule, timed rules, "
    "decomposition, interpretation";

}  // namespace

GrammarParser::GrammarParser(Grammar::Compiled& compiled, const std::map<std::string, double>& overrides)
    : out_(compiled), overrides_(overrides) {}

Cursor GrammarParser::cursor(const Statement& statement, std::size_t position) const {
  return {statement.text, out_.source + ":" + std::to_string(statement.line), position};
}

void GrammarParser::run(std::string_view text) {
  for (const Statement& statement : split_statements(text, out_.source)) read_statement(statement);
  check_overrides();
  for (const Statement& schedule : schedules_) {
    Cursor rest = cursor(schedule, schedule.text.find(':') + 1);
    read_schedule(rest);
  }
  if (schedules_.empty() && out_.groups.size() > 1)
    throw_invalid(out_.source, "groups of rules that no step uses", "a line `schedule: name*steps ...`");
  out_.ignored.resize(out_.symbols.size(), unlisted_is_ignored_);
  out_.open = out_.symbols.find("[");
  out_.close = out_.symbols.find("]");
  out_.timed.resize(out_.symbols.size(), 0);
  compile_axiom();
  compile_rules();
}

void GrammarParser::read_statement(const Statement& statement) {
  if (statement.text.starts_with("#define")) return define(statement);
  if (statement.text.find("-->") != std::string::npos) {
    pending_.push_back({statement, kind_, system_, group_});
    return;
  }
  const std::string keyword = keyword_of(statement.text);
  Cursor rest = cursor(statement, statement.text.find(':') + 1);
  if (keyword == "axiom") {
    axiom_ = statement;
  } else if (keyword == "schedule") {
    schedules_.push_back(statement);
  } else if (keyword.empty() ||
             !(read_section(keyword, rest) || read_number(keyword, rest) || read_symbols(keyword, rest))) {
    throw_invalid(rest.where, "neither a rule nor a known keyword: `" + statement.text + "`", kKeywords);
  } else {
    rest.skip_blanks();
    if (!rest.at_end()) rest.fail("text after the end of the statement", "nothing more");
  }
}

void GrammarParser::define(const Statement& statement) {
  Cursor rest = cursor(statement, std::string_view("#define").size());
  const std::string name = rest.identifier();
  if (name.empty()) rest.fail("a #define without a name", "#define NAME value");
  if (!defined_.insert(name).second) rest.fail("'" + name + "' is defined twice", "one #define per name");
  const double value = number(rest);
  const auto override_value = overrides_.find(name);
  out_.constants[name] = override_value == overrides_.end() ? value : override_value->second;
}

void GrammarParser::check_overrides() const {
  for (const auto& [name, value] : overrides_) {
    if (defined_.contains(name)) continue;
    std::string known;
    for (const std::string& one : defined_) known += (known.empty() ? "" : ", ") + one;
    throw_invalid(out_.source, "no constant '" + name + "' to replace",
                  known.empty() ? "a grammar with #define lines" : "one of " + known);
  }
}

double GrammarParser::number(Cursor& rest) {
  const Scope scope{&out_.constants, {}};
  const Program program = parse_expression(rest, scope);
  ModuleRandom fixed(0, 0);
  try {
    return evaluate(program, nullptr, fixed);
  } catch (const EvaluationFault& fault) {
    rest.fail(fault.problem, "a number");
  }
}

bool GrammarParser::read_section(const std::string& keyword, Cursor& rest) {
  if (keyword == "lsystem") return begin_system(rest), true;
  if (keyword == "endlsystem") return system_ = group_ = 0, kind_ = RuleKind::kProduction, true;
  if (keyword == "group") return begin_group(rest), true;
  if (keyword == "production") return kind_ = RuleKind::kProduction, group_ = 0, true;
  if (keyword == "timed rules") return kind_ = RuleKind::kTimed, true;
  if (keyword == "decomposition") return kind_ = RuleKind::kDecomposition, true;
  if (keyword == "interpretation") return kind_ = RuleKind::kInterpretation, true;
  return false;
}

bool GrammarParser::read_number(const std::string& keyword, Cursor& rest) {
  const std::map<std::string, double*> numbers{{"angle", &out_.angle_deg},
                                               {"step", &out_.step_m},
                                               {"width", &out_.width_m},
                                               {"width increment", &out_.width_increment_m},
                                               {"elasticity", &out_.elasticity}};
  if (const auto found = numbers.find(keyword); found != numbers.end())
    return *found->second = number(rest), true;
  if (keyword == "tropism") return read_tropism(rest), true;
  if (keyword != "steps" && keyword != "maximum depth") return false;
  const double value = number(rest);
  const double most = keyword == "steps" ? 1e6 : kMaxDepth;
  if (!(value >= 0 && value <= most && value == std::floor(value)))
    rest.fail("a count that cannot be", "a whole number of at most " + std::to_string(std::lround(most)));
  int& count = keyword == "steps"                   ? out_.steps
               : kind_ == RuleKind::kInterpretation ? out_.interpretation_depth
                                                    : out_.decomposition_depth;
  count = static_cast<int>(value);
  return true;
}

void GrammarParser::read_tropism(Cursor& rest) {
  for (int i = 0; i < 3; ++i) {
    if (i > 0) rest.expect(",", "tropism: x, y, z");
    out_.tropism[i] = number(rest);
  }
}

bool GrammarParser::read_symbols(const std::string& keyword, Cursor& rest) {
  if (keyword == "symbols") return declare_symbols(rest, false), true;
  if (keyword == "timed") return declare_symbols(rest, true), true;
  if (keyword == "draw") return mark_symbols(rest, TurtleOp::kDraw), true;
  if (keyword == "move") return mark_symbols(rest, TurtleOp::kMove), true;
  if (keyword == "organs") return mark_symbols(rest, TurtleOp::kOrgan), true;
  if (keyword == "ignore") return read_context_symbols(rest, true), true;
  if (keyword == "consider") return read_context_symbols(rest, false), true;
  return false;
}

void GrammarParser::declare_symbols(Cursor& rest, bool timed) {
  for (rest.skip_blanks(); !rest.at_end(); rest.skip_blanks()) {
    const std::size_t end = std::min(rest.text.find_first_of(" \t(", rest.position), rest.text.size());
    const std::string name(rest.text.substr(rest.position, end - rest.position));
    if (name.empty()) rest.fail("a symbol without a name", "name or name(number of parameters)");
    rest.position = end;
    const int least = timed ? 1 : 0;
    double arity = least;
    if (rest.peek() == '(') {
      ++rest.position;
      arity = number(rest);
      rest.expect(")", "name(number of parameters)");
    }
    if (!(arity >= least && arity <= kMaxParameters && arity == std::floor(arity)))
      rest.fail("a number of parameters that cannot be", timed ? "1 to 32, the last one the age" : "0 to 32");
    if (out_.symbols.size() >= kMostSymbols) rest.fail("too many symbols", "at most 60000");
    const std::uint16_t symbol = out_.symbols.declare(name, static_cast<int>(arity));
    out_.timed.resize(out_.symbols.size(), 0);
    out_.timed[symbol] = timed ? 1 : 0;
  }
}

std::uint16_t GrammarParser::known_symbol(Cursor& rest) {
  const std::uint16_t symbol = out_.symbols.longest_match(rest.text.substr(rest.position));
  if (symbol == SymbolTable::npos) rest.fail("undeclared symbol", "a turtle command or a declared name");
  rest.position += out_.symbols.at(symbol).name.size();
  return symbol;
}

void GrammarParser::mark_symbols(Cursor& rest, TurtleOp op) {
  for (rest.skip_blanks(); !rest.at_end(); rest.skip_blanks()) out_.symbols.set_op(known_symbol(rest), op);
}

void GrammarParser::read_context_symbols(Cursor& rest, bool listed_is_ignored) {
  unlisted_is_ignored_ = listed_is_ignored ? 0 : 1;
  out_.ignored.assign(out_.symbols.size(), unlisted_is_ignored_);
  for (rest.skip_blanks(); !rest.at_end(); rest.skip_blanks())
    out_.ignored[known_symbol(rest)] = listed_is_ignored ? 1 : 0;
}

void GrammarParser::begin_system(Cursor& rest) {
  const std::string name = rest.identifier();
  if (name.empty()) rest.fail("a system without a name", "lsystem: name");
  const auto known = std::find(system_names_.begin(), system_names_.end(), name);
  system_ = static_cast<std::size_t>(known - system_names_.begin());
  if (known == system_names_.end()) system_names_.push_back(name);
  kind_ = RuleKind::kProduction;
  group_ = 0;
}

void GrammarParser::begin_group(Cursor& rest) {
  const std::string name = rest.identifier();
  if (name.empty()) rest.fail("a group without a name", "group: name");
  const auto known = std::find(out_.groups.begin(), out_.groups.end(), name);
  group_ = static_cast<std::size_t>(known - out_.groups.begin());
  if (known == out_.groups.end()) out_.groups.push_back(name);
  kind_ = RuleKind::kProduction;
}

// `schedule: grow*10 signal`: the group of each step, from the start again when it is used up.
void GrammarParser::read_schedule(Cursor& rest) {
  out_.schedule.clear();
  for (rest.skip_blanks(); !rest.at_end(); rest.skip_blanks()) {
    const std::string name = rest.identifier();
    const auto group = std::find(out_.groups.begin() + 1, out_.groups.end(), name);
    if (group == out_.groups.end()) rest.fail("no group '" + name + "'", "a name from a `group:` line");
    const double times = rest.accept("*") ? number(rest) : 1;
    if (!(times >= 0 && times <= 1e5)) rest.fail("a count outside [0, 100000]", "a whole number");
    out_.schedule.insert(out_.schedule.end(), static_cast<std::size_t>(times),
                         static_cast<std::uint16_t>(group - out_.groups.begin()));
  }
  if (out_.schedule.empty()) rest.fail("a schedule without steps", "group names");
}

void GrammarParser::compile_axiom() {
  if (axiom_.text.empty()) throw_invalid(out_.source, "no axiom", "a line `axiom: modules`");
  out_.axiom_line = axiom_.line;
  Cursor text = cursor(axiom_, axiom_.text.find(':') + 1);
  Rule rule;
  RuleParser(text, out_.symbols, out_.constants, system_names_).parse_successor(rule);
  std::vector<double> values;
  ModuleRandom fixed(0, 0);
  for (const SuccessorModule& module : rule.successor) {
    values.clear();
    try {
      for (std::uint32_t i = 0; i < module.parameter_count; ++i)
        values.push_back(evaluate(rule.programs[module.first_program + i], nullptr, fixed));
    } catch (const EvaluationFault& fault) {
      text.fail(fault.problem, "finite parameters of '" + out_.symbols.at(module.symbol).name + "'");
    }
    out_.axiom.append(module.symbol, values);
  }
}

void GrammarParser::check_timed(const Rule& rule, const PendingRule& pending) const {
  if (pending.kind != RuleKind::kTimed || out_.timed[rule.predecessor.symbol]) return;
  throw_invalid(out_.where(rule), "a timed rule for a symbol without age: `" + rule.text + "`",
                "declare it: `timed: name(number of parameters)`");
}

void GrammarParser::compile_rules() {
  std::vector<RulePlace> places;
  for (const PendingRule& pending : pending_) {
    RuleParser parser(cursor(pending.statement), out_.symbols, out_.constants, system_names_);
    out_.rules.push_back(parser.parse_rule(pending.statement.line, pending.kind));
    check_timed(out_.rules.back(), pending);
    places.push_back({pending.kind, pending.system, pending.group});
  }
  build_rule_tables(out_, places, system_names_);
}

}  // namespace sunfleck::lsystem
