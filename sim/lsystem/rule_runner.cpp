#include "sim/lsystem/rule_runner.h"

namespace sunfleck::lsystem {

bool RuleRunner::guards_hold(const Rule& rule, double* slots, ModuleRandom& random) {
  for (const Assignment& it : rule.before) slots[it.slot] = number(it.value, slots, random);
  if (!rule.condition.empty() && number(rule.condition, slots, random) == 0) return false;
  for (const Assignment& it : rule.after) slots[it.slot] = number(it.value, slots, random);
  return true;
}

void RuleRunner::evaluate_module(const Rule& rule, const SuccessorModule& module, const double* slots,
                                 ModuleRandom& random, std::span<double> values) const {
  building_ = &module;
  for (std::size_t k = 0; k < values.size(); ++k)
    values[k] = number(rule.programs[module.first_program + k], slots, random);
}

void RuleRunner::produce(const Rule& rule, const double* slots, ModuleRandom& random, const System& system,
                         Direction direction, ModuleString& out, int depth) {
  if (out.size() + rule.successor.size() > max_modules_) fail_limit();
  const std::size_t count = rule.successor.size();
  for (std::size_t n = 0; n < count; ++n) {
    const SuccessorModule& module = rule.successor[direction == Direction::kForward ? n : count - 1 - n];
    rule_ = &rule;
    if (!system.decomposition.has(module.symbol)) {
      evaluate_module(rule, module, slots, random, out.append(module.symbol, module.parameter_count));
      continue;
    }
    double values[kMaxParameters];
    const std::span<double> used(values, module.parameter_count);
    evaluate_module(rule, module, slots, random, used);
    append(module.symbol, used, random, system, direction, out, depth);
  }
}

void RuleRunner::produce_plain(const Rule& rule, const double* slots, ModuleRandom& random,
                               ModuleString& out) {
  rule_ = &rule;
  for (const SuccessorModule& module : rule.successor)
    evaluate_module(rule, module, slots, random, out.append(module.symbol, module.parameter_count));
}

void RuleRunner::append(std::uint16_t symbol, std::span<const double> parameters, ModuleRandom& random,
                        const System& system, Direction direction, ModuleString& out, int depth) {
  double slots[kMaxSlots];
  const Rule* rule =
      choose(system.decomposition, symbol, parameters, slots, random, [](const Rule&) { return true; });
  if (rule == nullptr) {
    if (out.size() >= max_modules_) fail_limit();
    out.append(symbol, parameters);
    return;
  }
  if (depth >= grammar_.decomposition_depth)
    fail(ErrorKind::kLimitExceeded,
         "decomposition deeper than " + std::to_string(grammar_.decomposition_depth) + " levels",
         "a rule that ends, or a larger `maximum depth:`");
  // Modules that decompose into nothing never lengthen the string.
  applied_ = depth == 0 ? 1 : applied_ + 1;
  if (applied_ > max_modules_)
    fail(ErrorKind::kLimitExceeded,
         "more than " + std::to_string(max_modules_) + " decompositions of one module",
         "a rule that ends sooner");
  produce(*rule, slots, random, system, direction, out, depth + 1);
}

void RuleRunner::fail(ErrorKind kind, const std::string& problem, const std::string& remedy) const {
  std::string text = problem;
  if (rule_ != nullptr) text += " in rule `" + rule_->text + "`";
  if (building_ != nullptr) text += ", module '" + grammar_.symbols.at(building_->symbol).name + "'";
  throw Error(kind, rule_ != nullptr ? grammar_.where(*rule_) : grammar_.source, text, remedy);
}

void RuleRunner::fail_limit() const {
  fail(ErrorKind::kLimitExceeded, "a string of more than " + std::to_string(max_modules_) + " modules",
       "fewer steps or a larger limit");
}

}  // namespace sunfleck::lsystem
