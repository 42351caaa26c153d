#include "sim/lsystem/rule_table.h"

#include <algorithm>

#include "sim/base/error.h"

namespace sunfleck::lsystem {
namespace {

using Chooser = std::function<bool(const RulePlace&)>;

void note_contexts(RuleTable& table, const Rule& rule, const Grammar::Compiled& grammar) {
  table.uses_context |= !rule.left.empty() || !rule.right.empty();
  table.uses_new_left |= !rule.new_left.empty();
  table.backward |= !rule.new_right.empty();
  if (table.backward && table.uses_new_left)
    throw_invalid(grammar.where(rule), "<< and >> in one group: `" + rule.text + "`",
                  "groups of their own, run one after the other by `schedule:`");
}

RuleTable build_table(const Grammar::Compiled& grammar, const std::vector<RulePlace>& places,
                      const Chooser& chosen) {
  RuleTable table;
  std::vector<std::vector<std::uint32_t>> by_symbol(grammar.symbols.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!chosen(places[i])) continue;
    by_symbol[grammar.rules[i].predecessor.symbol].push_back(static_cast<std::uint32_t>(i));
    note_contexts(table, grammar.rules[i], grammar);
  }
  for (const auto& rules : by_symbol) {
    table.first.push_back(static_cast<std::uint32_t>(table.order.size()));
    table.order.insert(table.order.end(), rules.begin(), rules.end());
  }
  table.first.push_back(static_cast<std::uint32_t>(table.order.size()));
  return table;
}

System build_system(const Grammar::Compiled& grammar, const std::vector<RulePlace>& places,
                    const std::string& name, std::size_t index) {
  System system;
  system.name = name;
  for (std::size_t group = 0; group < grammar.groups.size(); ++group)
    system.productions.push_back(build_table(grammar, places, [&](const RulePlace& place) {
      return place.system == index && place.kind == RuleKind::kProduction &&
             (place.group == 0 || place.group == group);
    }));
  const auto of_kind = [&](RuleKind kind) {
    return build_table(grammar, places,
                       [&](const RulePlace& place) { return place.system == index && place.kind == kind; });
  };
  system.timed = of_kind(RuleKind::kTimed);
  system.decomposition = of_kind(RuleKind::kDecomposition);
  system.interpretation = of_kind(RuleKind::kInterpretation);
  return system;
}

bool is_query(TurtleOp op) { return op >= TurtleOp::kQueryPosition && op <= TurtleOp::kEnvironment; }

void note_op(Grammar::Compiled& grammar, TurtleOp op) {
  grammar.has_queries |= is_query(op);
  grammar.has_cut |= op == TurtleOp::kCut;
}

// Systems run side by side over one string, so all of them go the same way in a step.
void unify_direction(Grammar::Compiled& grammar) {
  for (std::size_t group = 0; group < grammar.groups.size(); ++group) {
    const auto backward = [&](const System& s) { return s.productions[group].backward; };
    const auto new_left = [&](const System& s) { return s.productions[group].uses_new_left; };
    const bool any = std::any_of(grammar.systems.begin(), grammar.systems.end(), backward);
    if (any && std::any_of(grammar.systems.begin(), grammar.systems.end(), new_left))
      throw_invalid(grammar.source, "systems with << and >> in group '" + grammar.groups[group] + "'",
                    "one direction per group");
    for (System& system : grammar.systems) system.productions[group].backward = any;
  }
}

}  // namespace

void build_rule_tables(Grammar::Compiled& grammar, const std::vector<RulePlace>& places,
                       const std::vector<std::string>& system_names) {
  for (std::size_t i = 0; i < system_names.size(); ++i)
    grammar.systems.push_back(build_system(grammar, places, system_names[i], i));
  unify_direction(grammar);
  for (const Rule& rule : grammar.rules)
    for (const SuccessorModule& module : rule.successor)
      note_op(grammar, grammar.symbols.at(module.symbol).op);
  for (std::size_t i = 0; i < grammar.axiom.size(); ++i)
    note_op(grammar, grammar.symbols.at(grammar.axiom.symbol(i)).op);
}

}  // namespace sunfleck::lsystem
