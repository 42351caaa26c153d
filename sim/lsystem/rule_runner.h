// Chooses and applies single rules: binding, guards, weights, evaluation of successors, decomposition; and
// says rule, line and module when something goes wrong.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/base/error.h"
#include "sim/lsystem/compiled.h"
#include "sim/lsystem/context.h"

namespace sunfleck::lsystem {

enum class Direction { kForward, kBackward };

class RuleRunner {
 public:
  RuleRunner(const Grammar::Compiled& grammar, std::size_t max_modules)
      : grammar_(grammar), max_modules_(max_modules) {}

  // The first rule of `table` that fits the module; if it carries a weight, one of all fitting weighted
  // rules, with a chance in proportion to its weight. Its names are bound in `slots`; nullptr if none fits.
  // bind_context(rule) matches contexts and binds their names.
  template <class BindContext>
  const Rule* choose(const RuleTable& table, std::uint16_t symbol, std::span<const double> parameters,
                     double* slots, ModuleRandom& random, const BindContext& bind_context);
  // Appends the successor, decomposed; in backward direction in reverse order.
  void produce(const Rule& rule, const double* slots, ModuleRandom& random, const System& system,
               Direction direction, ModuleString& out, int depth = 0);
  // Appends the successor as it is.
  void produce_plain(const Rule& rule, const double* slots, ModuleRandom& random, ModuleString& out);
  // Appends one module, decomposed as far as rules go.
  void append(std::uint16_t symbol, std::span<const double> parameters, ModuleRandom& random,
              const System& system, Direction direction, ModuleString& out, int depth);
  void copy(std::uint16_t symbol, std::span<const double> parameters, ModuleString& out) {
    if (out.size() >= max_modules_) fail_limit();
    out.append(symbol, parameters);
  }
  double number(const Program& program, const double* slots, ModuleRandom& random) const {
    return evaluate(program, slots, random);
  }
  // Runs `work` and turns an EvaluationFault into an Error with rule, line and module; `note` says which
  // module of the string was being rewritten, and when.
  template <class Work, class Note>
  void guarded(const Work& work, const Note& note);
  [[noreturn]] void fail(ErrorKind kind, const std::string& problem, const std::string& remedy) const;

 private:
  bool guards_hold(const Rule& rule, double* slots, ModuleRandom& random);
  void evaluate_module(const Rule& rule, const SuccessorModule& module, const double* slots,
                       ModuleRandom& random, std::span<double> values) const;
  [[noreturn]] void fail_limit() const;

  const Grammar::Compiled& grammar_;
  std::size_t max_modules_;
  std::size_t applied_ = 0;                               // decomposition rules, to one module
  const Rule* rule_ = nullptr;                            // being tried or applied
  std::vector<std::pair<const Rule*, double>> weighted_;  // fitting rules with the sum of weights up to each
  mutable const SuccessorModule* building_ = nullptr;     // module of its successor being evaluated
};

template <class BindContext>
const Rule* RuleRunner::choose(const RuleTable& table, std::uint16_t symbol,
                               std::span<const double> parameters, double* slots, ModuleRandom& random,
                               const BindContext& bind_context) {
  building_ = nullptr;
  const auto fits = [&](const Rule& rule) {
    rule_ = &rule;
    return bind_module(rule.predecessor, symbol, parameters, slots) && bind_context(rule) &&
           guards_hold(rule, slots, random);
  };
  const auto rules = table.rules(symbol);
  double total = 0;
  auto& weighted = weighted_;
  weighted.clear();
  for (const std::uint32_t index : rules) {
    const Rule& rule = grammar_.rules[index];
    if ((!weighted.empty() && rule.weight.empty()) || !fits(rule)) continue;
    if (rule.weight.empty()) return &rule;
    const double weight = number(rule.weight, slots, random);
    if (!(weight >= 0)) throw EvaluationFault{"a negative weight (or not a number)"};
    weighted.emplace_back(&rule, total += weight);
  }
  if (weighted.empty()) return nullptr;
  if (!(total > 0)) throw EvaluationFault{"weights that sum to zero"};
  const double drawn = random.uniform() * total;
  for (const auto& [rule, upto] : weighted)
    if (drawn < upto) return fits(*rule) ? rule : nullptr;
  return fits(*weighted.back().first) ? weighted.back().first : nullptr;
}

template <class Work, class Note>
void RuleRunner::guarded(const Work& work, const Note& note) {
  try {
    work();
  } catch (const EvaluationFault& fault) {
    fail(ErrorKind::kInvalidInput, std::string(fault.problem) + note(), "guard the rule by a condition");
  }
}

}  // namespace sunfleck::lsystem
