// Timed L-systems (ABOP chapter 6): a module ages; at its terminal age it is replaced, and its successors get
// the time that is left over, so that the result does not depend on how a lapse of time is divided.
#include <algorithm>
#include <cmath>

#include "sim/lsystem/derive.h"
#include "sim/lsystem/rule_runner.h"

namespace sunfleck::lsystem {
namespace {

constexpr std::size_t kModulesPerLook = 8192;
constexpr int kMostDivisions = 1000;  // of one module in one lapse of time

// Ages are sums of many small steps: what lies this close below the terminal age has reached it.
bool reached(double age, double terminal) { return age >= terminal - 1e-9 * std::max(1.0, terminal); }

class Ageing {
 public:
  Ageing(const Grammar::Compiled& grammar, const DeriveOptions& options)
      : grammar_(grammar), runner_(grammar, options.max_modules), seed_(options.seed) {}

  ModuleString run(const ModuleString& in, double duration, const RunControl& control) {
    const std::vector<std::uint16_t> system_of = systems_along(grammar_, in);
    const auto age_all = [&] {
      for (std::size_t i = 0; i < in.size(); ++i) {
        if (i % kModulesPerLook == 0) control.check();
        system_ = &grammar_.systems[system_of.empty() ? 0 : system_of[i]];
        ModuleRandom random(seed_, i);
        age_module(in, i, duration, random, 0);
      }
    };
    runner_.guarded(age_all, [] { return std::string(" while time passes"); });
    return std::move(out_);
  }

 private:
  void age_module(const ModuleString& from, std::size_t i, double duration, ModuleRandom& random, int depth) {
    const std::uint16_t symbol = from.symbol(i);
    if (!grammar_.timed[symbol]) return runner_.copy(symbol, from.parameters(i), out_);
    double values[kMaxParameters];
    const std::size_t count = from.parameters(i).size();
    std::copy_n(from.parameters(i).begin(), count, values);
    values[count - 1] += duration;
    if (system_->timed.has(symbol) && divide(symbol, {values, count}, random, depth)) return;
    runner_.copy(symbol, {values, count}, out_);
  }

  // Replaces a module that has reached its terminal age; false if it has not.
  bool divide(std::uint16_t symbol, std::span<double> values, ModuleRandom& random, int depth) {
    double slots[kMaxSlots];
    const Rule* rule =
        runner_.choose(system_->timed, symbol, values, slots, random, [](const Rule&) { return true; });
    if (rule == nullptr) return false;
    const double terminal = runner_.number(rule->terminal_age, slots, random);
    if (!(terminal > 0)) throw EvaluationFault{"a terminal age that is not positive"};
    const double age = values.back();
    if (!reached(age, terminal)) return false;
    if (depth >= kMostDivisions) throw EvaluationFault{"more than 1000 divisions in one lapse of time"};
    slots[rule->predecessor.first_slot + values.size() - 1] = terminal;  // its age when it divides
    ModuleString successors;
    runner_.produce(*rule, slots, random, *system_, Direction::kForward, successors);
    for (std::size_t k = 0; k < successors.size(); ++k)
      age_module(successors, k, age - terminal, random, depth + 1);
    return true;
  }

  const Grammar::Compiled& grammar_;
  RuleRunner runner_;
  std::uint64_t seed_;
  const System* system_ = nullptr;
  ModuleString out_;
};

}  // namespace

ModuleString let_time_pass(const Grammar::Compiled& grammar, const ModuleString& string, double duration,
                           const DeriveOptions& options, const RunControl& control) {
  return Ageing(grammar, options).run(string, duration, control);
}

}  // namespace sunfleck::lsystem
