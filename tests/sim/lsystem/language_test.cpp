// Parts of the language the golden cases do not reach: explicit branches in contexts, signals in one pass,
// groups, sub-systems, assignments, open modules, determinism.
#include <gtest/gtest.h>

#include "sim/lsystem/lsystem.h"
#include "tests/support/golden.h"

namespace sunfleck::lsystem {
namespace {

std::string derived(const std::string& text, int steps, std::uint64_t seed = 1) {
  const Grammar grammar = Grammar::parse(text, "test");
  DeriveOptions options;
  options.steps = steps;
  options.seed = seed;
  return grammar.print(grammar.derive(options));
}

// ABOP section 1.8: BC < S > G[H]M holds for the S of ABC[DE][SG[HI[JK]L]MNO].
TEST(Contexts, SkipBranchesAndAskForThem) {
  const std::string head = "symbols: A B C D E S H I J K L M N O X\naxiom: ABC[DE][SG[HI[JK]L]MNO]\n";
  EXPECT_EQ(derived(head + "BC < S > G[H]M --> X\n", 1), "ABC[DE][XG[HI[JK]L]MNO]");
  EXPECT_EQ(derived(head + "BC < S > G[I]M --> X\n", 1), "ABC[DE][SG[HI[JK]L]MNO]");
  EXPECT_EQ(derived(head + "S > GMN --> X\n", 1), "ABC[DE][XG[HI[JK]L]MNO]");
  EXPECT_EQ(derived(head + "E > S --> X\n", 1), "ABC[DE][SG[HI[JK]L]MNO]");
}

TEST(Contexts, ConsiderIgnoresAllOthers) {
  EXPECT_EQ(derived("symbols: A B X\nconsider: A B\naxiom: A+F-B\nA < B --> X\n", 1), "A+F-X");
}

// A signal runs the whole string in one step, in the direction of the new context.
TEST(NewContexts, CarryASignalInOnePass) {
  EXPECT_EQ(derived("symbols: I(1)\naxiom: I(1)I(1)[I(1)]I(1)\nI(x) << I(y) --> I(x+y)\n", 1),
            "I(1)I(2)[I(3)]I(3)");
  EXPECT_EQ(derived("symbols: I(1)\naxiom: I(1)I(1)[I(5)]I(1)\nI(y) >> I(x) --> I(x+y)\n", 1),
            "I(3)I(2)[I(5)]I(1)");
}

TEST(Groups, RunBySchedule) {
  const std::string text =
      "symbols: A B\naxiom: A\nschedule: grow*2 turn\ngroup: grow\nA --> AB\ngroup: turn\nB --> A\n";
  EXPECT_EQ(derived(text, 2), "ABB");
  EXPECT_EQ(derived(text, 3), "AAA");
  EXPECT_EQ(derived(text, 4), "ABABAB");
}

TEST(SubSystems, HaveRulesOfTheirOwn) {
  EXPECT_EQ(derived("symbols: A B\naxiom: A[@begin(inner)A]A@begin(inner)A@endA\nA --> B\n"
                    "lsystem: inner\nA --> AA\nendlsystem:\n",
                    1),
            "B[@begin(1)AA]B@begin(1)AA@endB");
}

TEST(Assignments, AreEvaluatedBeforeAndAfterTheCondition) {
  EXPECT_EQ(derived("symbols: A(2)\naxiom: A(3,4)\n"
                    "A(x,y) : {h = sqrt(x^2+y^2);} h == 5 && !(x > y) {z = h*2;} --> A(z, if(x<y, 1, 1/0))\n",
                    1),
            "A(10,1)");
}

TEST(Expressions, FollowPrecedence) {
  const auto value = [](const std::string& expression) {
    const std::string text = derived("symbols: A(1)\naxiom: A(" + expression + ")\n", 0);
    return std::stod(text.substr(2));
  };
  EXPECT_DOUBLE_EQ(value("2+3*4^2"), 50);
  EXPECT_DOUBLE_EQ(value("-2^2"), -4);
  EXPECT_DOUBLE_EQ(value("2^3^2"), 512);
  EXPECT_DOUBLE_EQ(value("7 % 4 - 8 / 4 / 2"), 2);
  EXPECT_DOUBLE_EQ(value("1 < 2 || 1/0 > 1"), 1);
  EXPECT_DOUBLE_EQ(value("2 > 3 && 1/0 > 1"), 0);
  EXPECT_DOUBLE_EQ(value("sin(30) + cos(60) + tan(45)"), 2);
  EXPECT_DOUBLE_EQ(value("atan2(1, 1) + min(3, floor(2.7)) + max(-1, abs(-2)) + round(0.6)"), 50);
  EXPECT_DOUBLE_EQ(value("log(exp(3)) + ceil(0.1) + sign(-4)"), 3);
}

TEST(Symbols, LongestDeclaredNameWins) {
  EXPECT_EQ(derived("symbols: Le Leaf(1) a f(0)\naxiom: LeLeaf(2)a\nLeaf(x) --> Lea\n", 1), "LeLeaa");
}

TEST(Environment, AnswersOpenModulesAndSeesTheTurtle) {
  const Grammar grammar = Grammar::parse("symbols: A\naxiom: F(2)?E(7)A\n?E(x) : x > 8 --> F(x)\n", "open");
  DeriveOptions options;
  options.steps = 1;
  EXPECT_ANY_THROW(grammar.derive(options));
  options.environment = [](const TurtleState& turtle, std::span<double> parameters) {
    parameters[0] += turtle.position_m.z;  // the turtle stands 2 m up
  };
  const ModuleString axiom = grammar.axiom();
  EXPECT_EQ(grammar.print(grammar.derive_step(axiom, 0, options)), "F(2)F(9)A");
  EXPECT_EQ(grammar.print(axiom), "F(2)?E(7)A");  // a run does not alter its axiom
}

TEST(Turtle, WidthsParentsAndPolygons) {
  const Grammar grammar = Grammar::parse(
      "width: 3\nwidth increment: 1\nangle: 90\norgans: @O\naxiom: F[!F]_F[+F{.f-f-f-f}]!(7);F@O(2)\n",
      "turtle");
  const Drawing drawing = grammar.interpret(grammar.axiom(), StartFrame::kTree);
  std::vector<double> widths;
  std::vector<int> parents;
  for (const Segment& s : drawing.segments) widths.push_back(s.width_to_m), parents.push_back(s.parent);
  EXPECT_EQ(widths, (std::vector<double>{3, 2, 4, 4, 7}));
  EXPECT_EQ(parents, (std::vector<int>{-1, 0, 0, 2, 2}));
  ASSERT_EQ(drawing.polygons.size(), 1u);
  EXPECT_EQ(drawing.polygons[0].corners_m.size(), 5u);
  ASSERT_EQ(drawing.organs.size(), 1u);
  EXPECT_EQ(drawing.organs[0].segment, 4);
  EXPECT_EQ(drawing.organs[0].parameters, std::vector<double>{2});
  EXPECT_NEAR(drawing.bounds.hi.z, 3, 1e-12);  // kTree: upwards is z
}

TEST(Determinism, SameSeedSameStringOtherSeedOther) {
  const std::string text =
      "symbols: A(1)\naxiom: A(1)A(1)A(1)A(1)A(1)A(1)A(1)A(1)\nA(x) --> A(x+ran(1))A(nran(0,1)) : 2\nA(x) "
      "--> A(x) : 1\n";
  EXPECT_EQ(derived(text, 5, 7), derived(text, 5, 7));
  EXPECT_NE(derived(text, 5, 7), derived(text, 5, 8));
}

// Every grammar we ship can be read, derived with its own constants and drawn.
TEST(ShippedGrammars, AllDraw) {
  int grammars = 0;
  DeriveOptions in_full_light;
  in_full_light.environment = [](const TurtleState&, std::span<double> parameters) {
    std::fill(parameters.begin(), parameters.end(), 1.0);
  };
  for (const auto& entry : std::filesystem::directory_iterator(test::source_dir() / "configs/grammars")) {
    if (entry.path().extension() != ".lsys") continue;
    const Grammar grammar = Grammar::load(entry.path());
    EXPECT_FALSE(grammar.interpret(grammar.derive(in_full_light), StartFrame::kTree).segments.empty())
        << entry.path();
    ++grammars;
  }
  EXPECT_GE(grammars, 3);
}

TEST(Stopping, IsHeard) {
  const Grammar grammar = Grammar::parse("axiom: F\nF --> FF\n", "stop");
  std::stop_source stop;
  stop.request_stop();
  DeriveOptions options;
  options.steps = 3;
  EXPECT_ANY_THROW(grammar.derive(options, {stop.get_token(), {}}));
}

}  // namespace
}  // namespace sunfleck::lsystem
