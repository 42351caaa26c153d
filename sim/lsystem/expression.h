// Arithmetic of grammars: expressions compiled once to a stack program over doubles. Angles of trigonometric
// functions are in degrees, as all angles of a grammar. Truth is 1, falsehood 0; && and || and if() evaluate
// only what they need.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim/base/random.h"

namespace sunfleck::lsystem {

enum class Op : std::uint8_t {
  kConstant,
  kSlot,  // a formal parameter or a local variable
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kModulo,
  kPower,
  kNegate,
  kNot,
  kLess,
  kLessEqual,
  kGreater,
  kGreaterEqual,
  kEqual,
  kNotEqual,
  kTruth,
  kJump,
  kJumpIfZero,   // takes the condition off the stack
  kAndShortcut,  // leaves 0 and jumps when the top is 0, else drops it
  kOrShortcut,   // leaves 1 and jumps when the top is not 0, else drops it
  kSqrt,
  kSin,
  kCos,
  kTan,
  kAsin,
  kAcos,
  kAtan,
  kAtan2,
  kExp,
  kLog,
  kMin,
  kMax,
  kAbs,
  kFloor,
  kCeil,
  kRound,
  kSign,
  kRan,     // ran(x): uniform in [0, x)
  kRange,   // rand(a, b): uniform in [a, b)
  kNormal,  // nran(mean, sd)
};

struct Instruction {
  Op op = Op::kConstant;
  std::uint16_t index = 0;  // slot, or target of a jump
  double value = 0;         // of a constant
};

using Program = std::vector<Instruction>;

inline constexpr int kStackDepth = 64;  // the parser refuses deeper expressions

// What went wrong inside an expression; the caller knows rule and module and turns it into an Error.
struct EvaluationFault {
  const char* problem;
};

// The random numbers of one module in one step; made only when first asked for.
class ModuleRandom {
 public:
  ModuleRandom(std::uint64_t step_seed, std::uint64_t position) : seed_(step_seed), position_(position) {}
  double uniform() { return stream().uniform(); }
  double normal() { return stream().normal(); }

 private:
  RandomStream& stream();
  std::uint64_t seed_, position_;
  std::optional<RandomStream> stream_;
};

// Throws EvaluationFault for division by zero, arguments outside a function's domain and a result that is not
// finite.
double evaluate_code(const Program& program, const double* slots, ModuleRandom& random);

inline double evaluate(const Program& program, const double* slots, ModuleRandom& random) {
  if (program.size() == 1) {
    const Instruction& only = program.front();
    return only.op == Op::kConstant ? only.value : slots[only.index];
  }
  return evaluate_code(program, slots, random);
}

// A program without slots and random numbers becomes a single constant (unless it faults: then the fault is
// reported where and when the program runs).
void fold_constant(Program& program);

}  // namespace sunfleck::lsystem
