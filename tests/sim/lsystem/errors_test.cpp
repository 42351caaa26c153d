// Mistakes in grammars: every message says where, what and what would be right.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "sim/base/error.h"
#include "sim/lsystem/lsystem.h"
#include "tests/support/golden.h"

namespace sunfleck::lsystem {
namespace {

struct Mistake {
  const char* name;
  const char* text;
  int steps;          // 0: found when the grammar is read
  const char* where;  // file and line
  const char* says;   // part of the message
  ErrorKind kind = ErrorKind::kInvalidInput;
};

class Mistakes : public testing::TestWithParam<Mistake> {};

void run(const Mistake& mistake) {
  const Grammar grammar = Grammar::parse(mistake.text, "bad.lsys");
  DeriveOptions options;
  options.steps = mistake.steps;
  options.max_modules = 1000;
  grammar.interpret(grammar.derive(options), StartFrame::kTree, options);
}

TEST_P(Mistakes, AreToldWithPlaceAndRemedy) {
  try {
    run(GetParam());
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), GetParam().kind);
    EXPECT_EQ(error.where().substr(0, std::string(GetParam().where).size()), GetParam().where)
        << error.what();
    EXPECT_NE(std::string(error.what()).find(GetParam().says), std::string::npos) << error.what();
    EXPECT_FALSE(error.remedy().empty()) << error.what();
  }
}

const Mistake kMistakes[] = {
    {"UndeclaredInAxiom", "axiom: FQ", 0, "bad.lsys:1", "undeclared symbol"},
    {"UndeclaredInRule", "axiom: F\n\nF --> FB", 0, "bad.lsys:3", "undeclared symbol"},
    {"NoAxiom", "F --> FF", 0, "bad.lsys", "no axiom"},
    {"Unbalanced", "axiom: F\nF --> F[F", 0, "bad.lsys:2", "unbalanced brackets"},
    {"UnbalancedClose", "axiom: F]F", 0, "bad.lsys:1", "unbalanced brackets"},
    {"WrongArity", "symbols: A(2)\naxiom: A(1)", 0, "bad.lsys:2", "'A' with 1 parameters"},
    {"UnknownName", "axiom: F\nF(x) --> F(y)", 0, "bad.lsys:2", "unknown name 'y'"},
    {"UnknownFunction", "axiom: F(foo(1))", 0, "bad.lsys:1", "unknown function 'foo'"},
    {"UnknownKeyword", "axiom: F\nangel: 30", 0, "bad.lsys:2", "neither a rule nor a known keyword"},
    {"TwoModules", "axiom: F\nFF --> F", 0, "bad.lsys:2", "rewrites 2 modules"},
    {"TwiceNamed", "symbols: A(2)\naxiom: A(1,2)\nA(x,x) --> F", 0, "bad.lsys:3", "stands for two"},
    {"Trailing", "axiom: F\nF --> F : 1 2", 0, "bad.lsys:2", "after the end of the rule"},
    {"BracketRewritten", "axiom: [F]\n[ --> F", 0, "bad.lsys:2", "rewrites a bracket"},
    {"LeftBracketContext", "axiom: [F]\nF] < F --> F", 0, "bad.lsys:2", "left context"},
    {"BothDirections", "axiom: F\nF << F >> F --> F", 0, "bad.lsys:2", "both << and >>"},
    {"NoSchedule", "axiom: F\ngroup: a\nF --> FF", 0, "bad.lsys", "no step uses"},
    {"UnknownSystem", "axiom: @begin(x)F", 0, "bad.lsys:1", "no system 'x'"},
    {"UnknownGroup", "schedule: a\naxiom: F", 0, "bad.lsys:1", "no group 'a'"},
    {"TimedUndeclared", "symbols: a(1)\naxiom: a(0)\ntimed rules:\na(t) : until 1 --> F", 0, "bad.lsys:4",
     "without age"},
    {"DefinedTwice", "#define A 1\n#define A 2\naxiom: F", 0, "bad.lsys:2", "defined twice"},
    {"OpenComment", "axiom: F\n/* never", 0, "bad.lsys:2", "never ends"},
    {"BrokenNumber", "axiom: F(1e999)", 0, "bad.lsys:1", "cannot be read"},
    {"ManySteps", "axiom: F\nsteps: -3", 0, "bad.lsys:2", "a count that cannot be"},
    {"DivisionByZero", "symbols: A(1)\naxiom: FA(0)\nA(x) --> F(1)A(1/x)", 1, "bad.lsys:3",
     "division by zero while rewriting module 1 `A(0)` in step 0 in rule `A(x) --> F(1)A(1/x)`, module 'A'"},
    {"DivisionInCondition", "symbols: A(1)\naxiom: A(0)\nA(x) : 1/x > 1 --> F", 1, "bad.lsys:3",
     "division by zero"},
    {"NotANumber", "symbols: A(1)\naxiom: A(-1)\nA(x) --> A(sqrt(x))", 1, "bad.lsys:3",
     "square root of a negative"},
    {"Logarithm", "axiom: F(log(0))", 0, "bad.lsys:1", "logarithm"},
    {"BrokenPower", "axiom: F((-2)^0.5)", 0, "bad.lsys:1", "broken power"},
    {"Overflow", "axiom: F(2)\nF(x) --> F(x^x)", 9, "bad.lsys:2", "not finite"},
    {"TooLong", "axiom: F\nF --> FF", 20, "bad.lsys:2", "more than 1000 modules", ErrorKind::kLimitExceeded},
    {"EndlessDecomposition", "symbols: A\naxiom: A\ndecomposition:\nA --> FA", 1, "bad.lsys:4",
     "deeper than 100 levels", ErrorKind::kLimitExceeded},
    {"DecompositionIntoNothing",
     "symbols: A(1)\naxiom: A(60)\ndecomposition:\nA(n) : n > 0 --> A(n-1)A(n-1)\nA(n) -->", 1,
     "bad.lsys:", "more than 1000 decompositions of one module", ErrorKind::kLimitExceeded},
    {"InterpretationIntoNothing", "symbols: A\naxiom: A\ninterpretation:\nmaximum depth: 60\nA --> A A", 1,
     "bad.lsys", "interpretation of one module by more than 1000 rules"},
    {"HugeArity", "symbols: A(1e300)\naxiom: A", 0, "bad.lsys:1", "parameters that cannot be"},
    {"BrokenArity", "symbols: A(1.5)\naxiom: A(1)", 0, "bad.lsys:1", "parameters that cannot be"},
    {"ZeroWeights", "axiom: F\nF --> FF : 0", 1, "bad.lsys:2", "weights that sum to zero"},
    {"NegativeWeight", "axiom: F\nF --> FF : -1", 0, "bad.lsys:2", "a negative weight"},
    {"NegativeWeightOfARuleThatNeverFits", "axiom: F\nF --> FF\nF --> F : 2-3", 0, "bad.lsys:3",
     "a negative weight (or not a number) at the end of `F --> F : 2-3`"},
    {"NegativeWeightByParameter", "axiom: F(2)\nF(x) --> F(1) : 3\nF(x) --> F(3) : 1-x", 1, "bad.lsys:3",
     "a negative weight (or not a number) while rewriting module 0 `F(2)` in step 0 in rule `F(x) --> F(3)"},
    {"NegativeWeightInDecomposition", "symbols: A(1)\naxiom: A(1)\ndecomposition:\nA(x) --> F : -x", 1,
     "bad.lsys:4", "a negative weight"},
    {"NegativeWeightInInterpretation", "symbols: A(1)\naxiom: A(1)\ninterpretation:\nA(x) --> F : -x", 1,
     "bad.lsys:4", "a negative weight"},
    {"NoNumberAsWeight", "axiom: F\nF --> FF : 0/0", 1, "bad.lsys:2", "division by zero"},
    {"PolygonOpen", "axiom: {F", 0, "bad.lsys", "never closed"},
    {"PolygonEnd", "axiom: F}", 0, "bad.lsys", "outside a polygon"},
    {"DeepParentheses",
     "axiom: "
     "F(((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((("
     "(((("
     "((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((("
     "(((((((((("
     "1)",
     0, "bad.lsys:1", "nested too deeply"},
};
INSTANTIATE_TEST_SUITE_P(Table, Mistakes, testing::ValuesIn(kMistakes),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(Constants, ReplaceDefinesAndNothingElse) {
  const char* text = "#define A 2\n#define B A*3\naxiom: F(B)\n";
  const auto printed = [&](const std::map<std::string, double>& constants) {
    const Grammar grammar = Grammar::parse(text, "c");
    const Grammar replaced = Grammar::parse(text, "c", constants);
    return replaced.print(replaced.axiom());
  };
  EXPECT_EQ(printed({}), "F(6)");
  EXPECT_EQ(printed({{"A", 5}}), "F(15)");
  EXPECT_EQ(printed({{"B", 5}}), "F(5)");
  EXPECT_THROW(printed({{"C", 5}}), Error);
}

// Constants of callers may be anything, and a NaN compares with nothing.
TEST(Weights, NanOfACallerIsRefused) {
  EXPECT_THROW(Grammar::parse("#define W 1\naxiom: F\nF --> FF : W\n", "w", {{"W", std::nan("")}}), Error);
}

TEST(Weights, OfZeroAreNeverDrawn) {
  const Grammar grammar = Grammar::parse("axiom: F\nF --> FF : 0\nF --> +F : 1\n", "w");
  for (const std::uint64_t seed : {1, 2, 3}) {
    DeriveOptions options;
    options.seed = seed;
    options.steps = 1;
    EXPECT_EQ(grammar.print(grammar.derive(options)), "+F");
  }
}

TEST(Files, FoldersAreNone) {
  try {
    Grammar::load(test::scratch_dir());
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), test::scratch_dir().string());
    EXPECT_EQ(error.problem(), "is a folder, not a file");
  }
}

TEST(Files, DevicesWithoutEndAreNone) { EXPECT_THROW(Grammar::load("/dev/zero"), Error); }

TEST(Files, AbsentOnesAreNamed) {
  try {
    Grammar::load(test::scratch_dir() / "absent.lsys");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kNotFound);
    EXPECT_NE(error.where().find("absent.lsys"), std::string::npos);
  }
}

TEST(Durations, MustBePositive) {
  const Grammar grammar = Grammar::parse("timed: a\naxiom: a(0)\n", "t");
  for (const double duration : {0.0, -1.0, std::nan("")})
    EXPECT_THROW(grammar.advance(grammar.axiom(), duration, {}), Error) << duration;
}

}  // namespace
}  // namespace sunfleck::lsystem
