#include "sim/lsystem/derive.h"

#include "sim/lsystem/rule_runner.h"

namespace sunfleck::lsystem {
namespace {

constexpr std::size_t kModulesPerLook = 8192;  // below 10 ms of work
constexpr std::uint64_t kAxiomSeed = ~std::uint64_t{0};

// What one step knows: the string as it was, the string so far, and brackets of both where rules ask for
// them.
class Step {
 public:
  Step(const Grammar::Compiled& grammar, const ModuleString& in, int number, const DeriveOptions& options)
      : grammar_(grammar),
        in_(in),
        number_(number),
        seed_(mix_seed(options.seed, static_cast<std::uint64_t>(number))),
        group_(grammar.schedule[static_cast<std::size_t>(number) % grammar.schedule.size()]),
        system_of_(systems_along(grammar, in)),
        in_brackets_(grammar.open, grammar.close),
        direction_(grammar.systems[0].productions[group_].backward ? Direction::kBackward
                                                                   : Direction::kForward),
        out_brackets_(direction_ == Direction::kForward ? grammar.open : grammar.close,
                      direction_ == Direction::kForward ? grammar.close : grammar.open),
        runner_(grammar, options.max_modules) {}

  ModuleString run(const RunControl& control) {
    note_contexts();
    out_.reserve(in_.size() + in_.size() / 2, in_.size());
    runner_.guarded([&] { rewrite_all(control); }, [&] { return note(); });
    return direction_ == Direction::kForward ? std::move(out_) : out_.reversed();
  }

 private:
  void note_contexts() {
    bool old_contexts = false;
    for (const System& system : grammar_.systems) {
      const RuleTable& table = system.productions[group_];
      old_contexts |= table.uses_context;
      new_contexts_ |= table.uses_new_left || table.backward;
    }
    if (old_contexts) in_brackets_.extend(in_);
  }

  void rewrite_all(const RunControl& control) {
    const std::size_t count = in_.size();
    for (std::size_t n = 0; n < count; ++n) {
      if (n % kModulesPerLook == 0) control.check();
      rewrite_module(direction_ == Direction::kForward ? n : count - 1 - n);
      if (new_contexts_) out_brackets_.extend(out_);
    }
  }

  void rewrite_module(std::size_t i) {
    current_ = i;
    const System& system = grammar_.systems[system_of_.empty() ? 0 : system_of_[i]];
    const RuleTable& table = system.productions[group_];
    const std::uint16_t symbol = in_.symbol(i);
    if (!table.has(symbol)) return runner_.copy(symbol, in_.parameters(i), out_);
    double slots[kMaxSlots];
    ModuleRandom random(seed_, i);
    const Rule* rule = runner_.choose(table, symbol, in_.parameters(i), slots, random, [&](const Rule& it) {
      return !it.has_context() || bind_contexts(it, i, slots);
    });
    if (rule == nullptr) return runner_.copy(symbol, in_.parameters(i), out_);
    runner_.produce(*rule, slots, random, system, direction_, out_);
  }

  bool bind_contexts(const Rule& rule, std::size_t i, double* slots) const {
    const PlainView before{in_, in_brackets_.partners()};
    const auto at = static_cast<std::ptrdiff_t>(i);
    if (!rule.left.empty() && !match_left(before, at - 1, rule.left, grammar_, slots)) return false;
    if (!rule.right.empty() && !match_right(before, at + 1, rule.right, grammar_, slots)) return false;
    const PlainView produced{out_, out_brackets_.partners()};
    if (!rule.new_left.empty() && !match_left(produced, produced.size() - 1, rule.new_left, grammar_, slots))
      return false;
    const ReversedView ahead{out_, out_brackets_.partners()};
    return rule.new_right.empty() || match_right(ahead, 0, rule.new_right, grammar_, slots);
  }

  std::string note() const {
    ModuleString module;
    module.append(in_.symbol(current_), in_.parameters(current_));
    return " while rewriting module " + std::to_string(current_) + " `" + print_modules(grammar_, module) +
           "` in step " + std::to_string(number_);
  }

  const Grammar::Compiled& grammar_;
  const ModuleString& in_;
  int number_;
  std::uint64_t seed_;
  std::size_t group_;
  std::vector<std::uint16_t> system_of_;
  BracketPartners in_brackets_;
  Direction direction_;
  BracketPartners out_brackets_;
  bool new_contexts_ = false;
  RuleRunner runner_;
  ModuleString out_;
  std::size_t current_ = 0;
};

}  // namespace

ModuleString decompose_axiom(const Grammar::Compiled& grammar, const DeriveOptions& options) {
  ModuleString out;
  const System& system = grammar.systems[0];
  RuleRunner runner(grammar, options.max_modules);
  const auto append_all = [&] {
    for (std::size_t i = 0; i < grammar.axiom.size(); ++i) {
      ModuleRandom random(mix_seed(options.seed, kAxiomSeed), i);
      runner.append(grammar.axiom.symbol(i), grammar.axiom.parameters(i), random, system, Direction::kForward,
                    out, 0);
    }
  };
  runner.guarded(append_all, [] { return std::string(" in the axiom"); });
  return out;
}

ModuleString rewrite(const Grammar::Compiled& grammar, const ModuleString& string, int step,
                     const DeriveOptions& options, const RunControl& control) {
  return Step(grammar, string, step, options).run(control);
}

ModuleString without_cut_branches(const Grammar::Compiled& grammar, const ModuleString& string) {
  ModuleString kept;
  kept.reserve(string.size(), string.size());
  int depth = 0;  // of brackets inside the part that is cut
  bool cutting = false;
  for (std::size_t i = 0; i < string.size(); ++i) {
    const TurtleOp op = grammar.symbols.at(string.symbol(i)).op;
    if (cutting) {
      if (op == TurtleOp::kPush) ++depth;
      if (op != TurtleOp::kPop || depth-- > 0) continue;
      cutting = false;
    } else if (op == TurtleOp::kCut) {
      cutting = true;
      depth = 0;
      continue;
    }
    kept.append(string.symbol(i), string.parameters(i));
  }
  return kept;
}

std::vector<std::uint16_t> systems_along(const Grammar::Compiled& grammar, const ModuleString& string) {
  std::vector<std::uint16_t> result;
  if (grammar.systems.size() < 2) return result;
  std::vector<std::vector<std::uint16_t>> branches{{0}};  // the open systems of each open branch
  for (std::size_t i = 0; i < string.size(); ++i) {
    const TurtleOp op = grammar.symbols.at(string.symbol(i)).op;
    if (op == TurtleOp::kPop && branches.size() > 1) branches.pop_back();
    if (op == TurtleOp::kSystemEnd && branches.back().size() > 1) branches.back().pop_back();
    result.push_back(branches.back().back());
    if (op == TurtleOp::kPush) branches.push_back({branches.back().back()});
    if (op == TurtleOp::kSystemBegin)
      branches.back().push_back(static_cast<std::uint16_t>(string.parameters(i)[0]));
  }
  return result;
}

}  // namespace sunfleck::lsystem
