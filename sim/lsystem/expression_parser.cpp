#include "sim/lsystem/expression_parser.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

namespace sunfleck::lsystem {
namespace {

struct Function {
  const char* name;
  int arguments;
  Op op;
};
constexpr std::array kFunctions{
    Function{"sqrt", 1, Op::kSqrt},   Function{"sin", 1, Op::kSin},     Function{"cos", 1, Op::kCos},
    Function{"tan", 1, Op::kTan},     Function{"asin", 1, Op::kAsin},   Function{"acos", 1, Op::kAcos},
    Function{"atan", 1, Op::kAtan},   Function{"atan2", 2, Op::kAtan2}, Function{"exp", 1, Op::kExp},
    Function{"log", 1, Op::kLog},     Function{"min", 2, Op::kMin},     Function{"max", 2, Op::kMax},
    Function{"abs", 1, Op::kAbs},     Function{"floor", 1, Op::kFloor}, Function{"ceil", 1, Op::kCeil},
    Function{"round", 1, Op::kRound}, Function{"sign", 1, Op::kSign},   Function{"ran", 1, Op::kRan},
    Function{"rand", 2, Op::kRange},  Function{"nran", 2, Op::kNormal},
};

constexpr int kNesting = 200;

struct Operator {
  const char* token;
  Op op;
};
// One row per strength, weakest first; longer tokens before their beginnings.
const std::vector<std::vector<Operator>> kBinaryLevels{
    {{"==", Op::kEqual}, {"!=", Op::kNotEqual}},
    {{"<=", Op::kLessEqual}, {">=", Op::kGreaterEqual}, {"<", Op::kLess}, {">", Op::kGreater}},
    {{"+", Op::kAdd}, {"-", Op::kSubtract}},
    {{"*", Op::kMultiply}, {"/", Op::kDivide}, {"%", Op::kModulo}},
};

class Parser {
 public:
  Parser(Cursor& cursor, const Scope& scope) : cursor_(cursor), scope_(scope) {}

  Program run() {
    disjunction();
    return std::move(code_);
  }

 private:
  void emit(Op op, std::uint16_t index = 0, double value = 0) { code_.push_back({op, index, value}); }
  std::size_t emit_jump(Op op) {
    emit(op);
    return code_.size() - 1;
  }
  void land(std::size_t jump) { code_[jump].index = static_cast<std::uint16_t>(code_.size()); }

  // Every value in flight takes a place on the evaluation stack.
  void push_value(Op op, std::uint16_t index, double value) {
    emit(op, index, value);
    if (++values_ > kStackDepth) cursor_.fail("an expression with too many values", "split it by {assign}");
  }

  void disjunction() {
    conjunction();
    while (cursor_.accept("||")) {
      const std::size_t end = emit_jump(Op::kOrShortcut);
      conjunction();
      emit(Op::kTruth);
      land(end);
    }
  }

  void conjunction() {
    binary(0);
    while (cursor_.accept("&&")) {
      const std::size_t end = emit_jump(Op::kAndShortcut);
      binary(0);
      emit(Op::kTruth);
      land(end);
    }
  }

  void binary(std::size_t level) {
    if (level == kBinaryLevels.size()) return unary();
    binary(level + 1);
    for (;;) {
      const auto& row = kBinaryLevels[level];
      const auto hit =
          std::find_if(row.begin(), row.end(), [&](const Operator& o) { return accept_operator(o.token); });
      if (hit == row.end()) return;
      binary(level + 1);
      emit(hit->op);
    }
  }

  // `-->` ends a condition and is no subtraction.
  bool accept_operator(std::string_view token) {
    cursor_.skip_blanks();
    if (token == "-" && cursor_.text.substr(cursor_.position, 3) == "-->") return false;
    return cursor_.accept(token);
  }

  void unary() {
    if (++depth_ > kNesting) cursor_.fail("an expression nested too deeply", "split it by {assign}");
    signed_value();
    --depth_;
  }

  void signed_value() {
    if (accept_operator("-")) return unary(), emit(Op::kNegate);
    if (cursor_.accept("!")) return unary(), emit(Op::kNot);
    if (cursor_.accept("+")) return unary();
    primary();
    if (cursor_.accept("^")) {
      unary();
      emit(Op::kPower);
    }
  }

  void primary() {
    if (cursor_.accept("(")) {
      disjunction();
      return cursor_.expect(")", "close the parenthesis");
    }
    if (std::isdigit(static_cast<unsigned char>(cursor_.peek())) || cursor_.peek() == '.') return number();
    const std::string name = cursor_.identifier();
    if (name.empty()) cursor_.fail("expected a number, a name or '('", "an expression such as 2*x+1");
    if (cursor_.accept("(")) return call(name);
    variable(name);
  }

  void number() {
    double value = 0;
    const char* begin = cursor_.text.data() + cursor_.position;
    const auto [end, error] = std::from_chars(begin, cursor_.text.data() + cursor_.text.size(), value);
    if (error != std::errc()) cursor_.fail("a number that cannot be read", "a decimal number such as 0.25");
    cursor_.position += static_cast<std::size_t>(end - begin);
    push_value(Op::kConstant, 0, value);
  }

  void variable(const std::string& name) {
    const auto slot = std::find(scope_.slots.begin(), scope_.slots.end(), name);
    if (slot != scope_.slots.end())
      return push_value(Op::kSlot, static_cast<std::uint16_t>(slot - scope_.slots.begin()), 0);
    const auto constant = scope_.constants->find(name);
    if (constant == scope_.constants->end())
      cursor_.fail("unknown name '" + name + "'", "a parameter of the rule, an assigned name or a #define");
    push_value(Op::kConstant, 0, constant->second);
  }

  void call(const std::string& name) {
    if (name == "if") return choice();
    const auto* function =
        std::find_if(kFunctions.begin(), kFunctions.end(), [&](const Function& f) { return name == f.name; });
    if (function == kFunctions.end()) cursor_.fail("unknown function '" + name + "'", known_functions());
    for (int i = 0; i < function->arguments; ++i) {
      if (i > 0) cursor_.expect(",", "all arguments of the function");
      disjunction();
    }
    cursor_.expect(")", "close the arguments");
    emit(function->op);
  }

  void choice() {  // if(condition, then, else)
    disjunction();
    cursor_.expect(",", "if(condition, value, other)");
    const std::size_t to_else = emit_jump(Op::kJumpIfZero);
    disjunction();
    cursor_.expect(",", "if(condition, value, other)");
    const std::size_t to_end = emit_jump(Op::kJump);
    land(to_else);
    disjunction();
    land(to_end);
    cursor_.expect(")", "close the arguments");
  }

  static std::string known_functions() {
    std::string list = "one of if";
    for (const Function& f : kFunctions) list += std::string(" ") + f.name;
    return list;
  }

  Cursor& cursor_;
  const Scope& scope_;
  Program code_;
  int values_ = 0, depth_ = 0;
};

}  // namespace

Program parse_expression(Cursor& cursor, const Scope& scope) {
  Program program = Parser(cursor, scope).run();
  fold_constant(program);
  return program;
}

}  // namespace sunfleck::lsystem
