#include "sim/lsystem/expression.h"

#include <algorithm>
#include <cmath>

#include "sim/base/vec.h"

namespace sunfleck::lsystem {
namespace {

void require(bool fine, const char* problem) {
  if (!fine) throw EvaluationFault{problem};
}

double divide(double a, double b) {
  require(b != 0, "division by zero");
  return a / b;
}

double modulo(double a, double b) {
  require(b != 0, "remainder of a division by zero");
  return std::fmod(a, b);
}

double power(double a, double b) {
  if (b == 2) return a * a;
  const double result = std::pow(a, b);
  require(!std::isnan(result), "a negative number to a broken power");
  return result;
}

double square_root(double a) {
  require(a >= 0, "square root of a negative number");
  return std::sqrt(a);
}

double logarithm(double a) {
  require(a > 0, "logarithm of a number that is not positive");
  return std::log(a);
}

double arc(Op op, double a) {
  require(a >= -1 && a <= 1, "arc sine or cosine of a number outside [-1, 1]");
  return degrees_from_radians(op == Op::kAsin ? std::asin(a) : std::acos(a));
}

double unary(Op op, double a) {
  switch (op) {
    case Op::kNegate:
      return -a;
    case Op::kNot:
      return a == 0 ? 1 : 0;
    case Op::kTruth:
      return a != 0 ? 1 : 0;
    case Op::kSqrt:
      return square_root(a);
    case Op::kSin:
      return std::sin(radians_from_degrees(a));
    case Op::kCos:
      return std::cos(radians_from_degrees(a));
    case Op::kTan:
      return std::tan(radians_from_degrees(a));
    case Op::kAsin:
    case Op::kAcos:
      return arc(op, a);
    case Op::kAtan:
      return degrees_from_radians(std::atan(a));
    case Op::kExp:
      return std::exp(a);
    case Op::kLog:
      return logarithm(a);
    case Op::kAbs:
      return std::abs(a);
    case Op::kFloor:
      return std::floor(a);
    case Op::kCeil:
      return std::ceil(a);
    case Op::kRound:
      return std::round(a);
    default:
      return a > 0 ? 1 : (a < 0 ? -1 : 0);  // kSign
  }
}

double binary(Op op, double a, double b, ModuleRandom& random) {
  switch (op) {
    case Op::kAdd:
      return a + b;
    case Op::kSubtract:
      return a - b;
    case Op::kMultiply:
      return a * b;
    case Op::kDivide:
      return divide(a, b);
    case Op::kModulo:
      return modulo(a, b);
    case Op::kPower:
      return power(a, b);
    case Op::kLess:
      return a < b ? 1 : 0;
    case Op::kLessEqual:
      return a <= b ? 1 : 0;
    case Op::kGreater:
      return a > b ? 1 : 0;
    case Op::kGreaterEqual:
      return a >= b ? 1 : 0;
    case Op::kEqual:
      return a == b ? 1 : 0;
    case Op::kNotEqual:
      return a != b ? 1 : 0;
    case Op::kAtan2:
      return degrees_from_radians(std::atan2(a, b));
    case Op::kMin:
      return std::min(a, b);
    case Op::kMax:
      return std::max(a, b);
    case Op::kRange:
      return a + (b - a) * random.uniform();
    default:
      return a + b * random.normal();  // kNormal
  }
}

bool is_binary(Op op) {
  return (op >= Op::kAdd && op <= Op::kPower) || (op >= Op::kLess && op <= Op::kNotEqual) ||
         op == Op::kAtan2 || op == Op::kMin || op == Op::kMax || op == Op::kRange || op == Op::kNormal;
}

bool is_random(Op op) { return op == Op::kRan || op == Op::kRange || op == Op::kNormal; }

// Moves over a jump; `top` points at the highest value on the stack.
std::size_t follow_jump(const Instruction& jump, std::size_t next, double*& top) {
  switch (jump.op) {
    case Op::kJump:
      return jump.index;
    case Op::kJumpIfZero:
      return *top-- == 0 ? jump.index : next;
    case Op::kAndShortcut:
      if (*top == 0) return jump.index;
      --top;
      return next;
    default:  // kOrShortcut
      if (*top != 0) return *top = 1, jump.index;
      --top;
      return next;
  }
}

}  // namespace

RandomStream& ModuleRandom::stream() {
  if (!stream_) stream_.emplace(seed_, position_, RandomPurpose::kLsystem);
  return *stream_;
}

double evaluate_code(const Program& program, const double* slots, ModuleRandom& random) {
  double stack[kStackDepth];
  double* top = stack - 1;
  for (std::size_t next = 0; next < program.size();) {
    const Instruction& it = program[next++];
    switch (it.op) {
      case Op::kConstant:
        *++top = it.value;
        break;
      case Op::kSlot:
        *++top = slots[it.index];
        break;
      case Op::kAdd:
        --top, top[0] += top[1];
        break;
      case Op::kSubtract:
        --top, top[0] -= top[1];
        break;
      case Op::kMultiply:
        --top, top[0] *= top[1];
        break;
      case Op::kJump:
      case Op::kJumpIfZero:
      case Op::kAndShortcut:
      case Op::kOrShortcut:
        next = follow_jump(it, next, top);
        break;
      case Op::kRan:
        *top *= random.uniform();
        break;
      default:
        if (is_binary(it.op)) {
          --top;
          top[0] = binary(it.op, top[0], top[1], random);
        } else {
          *top = unary(it.op, *top);
        }
    }
  }
  require(std::isfinite(*top), "a result that is not finite");
  return *top;
}

void fold_constant(Program& program) {
  const bool variable = std::any_of(program.begin(), program.end(), [](const Instruction& it) {
    return it.op == Op::kSlot || is_random(it.op);
  });
  if (variable) return;
  ModuleRandom unused(0, 0);
  try {
    const double value = evaluate_code(program, nullptr, unused);
    program.assign(1, Instruction{Op::kConstant, 0, value});
  } catch (const EvaluationFault&) {
    return;  // reported when it runs
  }
}

}  // namespace sunfleck::lsystem
