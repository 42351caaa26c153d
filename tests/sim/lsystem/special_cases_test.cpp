// The six golden cases that are descriptions rather than lists of rules: pruning by position, stochastic
// choice, timed modules, decomposition and interpretation, phyllotaxis, pipe model.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry_check.h"
#include "sim/base/vec.h"
#include "sim/lsystem/lsystem.h"
#include "tests/support/golden.h"

namespace sunfleck::lsystem {
namespace {

nlohmann::json golden_case(const std::string& id) {
  const nlohmann::json file = test::golden("lsystem.json");
  for (const auto& one : file["cases"])
    if (one["id"] == id) return one;
  throw std::runtime_error("no case " + id);
}

std::size_t count_of(const Grammar& grammar, const ModuleString& string, const std::string& name) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < string.size(); ++i)
    if (grammar.symbol_names()[string.symbol(i)] == name) ++count;
  return count;
}

TEST(GoldenEnvironment, EllipsePruning) {
  const auto golden = golden_case("env_sensitive_ellipse_pruning");
  const Grammar grammar = Grammar::parse(R"(
symbols: A B
axiom: A
A --> [+(60)B][-(60)B]F?P(0,0,0)A
B --> F?P(0,0,0)@O(0.2)B
?P(x,y,z) : 4*x^2+(y-10)^2>100 --> [+(2*y)F][-(2*y)F]%
?P(x,y,z) -->
)",
                                         "ellipse");
  DeriveOptions options;
  options.frame = StartFrame::kAbop;
  ModuleString string = grammar.axiom();
  for (const auto& expected : golden["expected"]) {
    const int n = expected["n"];
    SCOPED_TRACE("n = " + std::to_string(n));
    if (n > 0) string = grammar.derive_step(string, n - 1, options);
    for (const char* symbol : {"F", "A", "B"})
      EXPECT_EQ(count_of(grammar, string, symbol), expected[symbol].get<std::size_t>()) << symbol;
    expect_geometry(grammar.interpret(string, StartFrame::kAbop), expected["geometry"]);
  }
}

// 1e4 seeds, mean within 4 standard errors: a false alarm has a chance of 6e-5 per step (two-sided normal).
TEST(GoldenStochastic, MeanOverTenThousandSeeds) {
  const auto golden = golden_case("stochastic_1_27");
  const Grammar grammar = Grammar::parse(R"(
axiom: F
F --> F[+F]F[-F]F : 0.33
F --> F[+F]F : 0.33
F --> F[-F]F : 0.34
)",
                                         "stochastic");
  constexpr int kSeeds = 10000;
  std::vector<double> sum(golden["expected"].size(), 0);
  for (int seed = 0; seed < kSeeds; ++seed) {
    DeriveOptions options;
    options.seed = static_cast<std::uint64_t>(seed);
    ModuleString string = grammar.axiom();
    for (std::size_t n = 0; n < sum.size(); ++n) {
      if (n > 0) string = grammar.derive_step(string, static_cast<int>(n) - 1, options);
      const auto count = static_cast<double>(count_of(grammar, string, "F"));
      ASSERT_GE(count, golden["expected"][n]["min"].get<double>());
      ASSERT_LE(count, golden["expected"][n]["max"].get<double>());
      sum[n] += count;
    }
  }
  for (std::size_t n = 0; n < sum.size(); ++n)
    EXPECT_NEAR(sum[n] / kSeeds, golden["expected"][n]["mean"].get<double>(),
                4 * golden["expected"][n]["sd"].get<double>() / 100)
        << "n = " << n;
}

const char* kTimedAnabaena = R"(
timed: a b
axiom: a(0)
timed rules:
a(age) : until 1 --> a(0)b(0)
b(age) : until 1 --> a(0)
)";

// Cells at time t whatever the steps of time: Fib(floor(t) + 2). The ages of all cells are t - floor(t).
TEST(GoldenTimed, CellsDoNotDependOnTheStepOfTime) {
  const auto golden = golden_case("timed_anabaena");
  const Grammar grammar = Grammar::parse(kTimedAnabaena, "timed");
  for (const double dt : {1.0, 0.5, 0.1, 1.0 / 3.0}) {
    for (const auto& expected : golden["expected"]) {
      const double t = expected["t"];
      SCOPED_TRACE("dt = " + std::to_string(dt) + ", t = " + std::to_string(t));
      ModuleString string = grammar.axiom();
      const int whole = static_cast<int>(std::floor(t / dt + 1e-9));
      for (int i = 0; i < whole; ++i) string = grammar.advance(string, dt, {});
      if (const double rest = t - whole * dt; rest > 1e-9) string = grammar.advance(string, rest, {});
      EXPECT_EQ(string.size(), expected["cells"].get<std::size_t>());
      for (std::size_t i = 0; i < string.size(); i += 97)
        EXPECT_NEAR(string.parameters(i)[0], t - std::floor(t + 1e-9), 1e-9);
    }
  }
}

TEST(GoldenDecomposition, DecomposesInTheStringAndInterpretsOnlyTheDrawing) {
  const auto golden = golden_case("decomposition_homomorphism");
  const Grammar grammar = Grammar::parse(R"(
symbols: A(1) D(1)
axiom: A(8)
A(n) --> D(n)A(n)
decomposition:
D(n) : n>1 --> F(1)D(n-1)
D(n) : n<=1 --> F(1)
interpretation:
F(x) --> f(0.5)F(x-0.5)
)",
                                         "decomposition");
  for (const auto& expected : golden["expected"]) {
    DeriveOptions options;
    options.steps = expected["n"];
    const ModuleString string = grammar.derive(options);
    const ModuleString before = string;
    EXPECT_EQ(count_of(grammar, string, "F"), expected["F"].get<std::size_t>());
    EXPECT_NEAR(grammar.interpret(string, StartFrame::kAbop).total_length_m,
                expected["drawn_length"].get<double>(), 1e-9);
    EXPECT_EQ(string, before);
  }
}

TEST(GoldenPhyllotaxis, VogelSpiral) {
  const auto golden = golden_case("vogel_phyllotaxis");
  const Grammar grammar = Grammar::parse(R"(
symbols: A(1) D
steps: 501
axiom: A(0)
A(k) --> [+(k*137.5)f(sqrt(k))~D]A(k+1)
)",
                                         "vogel");
  const Drawing drawing = grammar.interpret(grammar.derive({}), StartFrame::kAbop);
  ASSERT_EQ(drawing.organs.size(), 501u);
  for (const auto& expected : golden["expected"]) {
    const Organ& organ = drawing.organs[expected["k"].get<std::size_t>()];
    EXPECT_EQ(organ.symbol, "D");
    const Vec3 at = organ.turtle.position_m;
    EXPECT_NEAR(glm::length(at), expected["r"].get<double>(), 1e-6);
    // Azimuth from the heading at the start (+y), counted to the left.
    const double azimuth_deg = std::fmod(degrees_from_radians(std::atan2(-at.x, at.y)) + 360, 360);
    EXPECT_NEAR(azimuth_deg, expected["azimuth_deg"].get<double>(), 1e-6);
  }
}

// A binary tree of 2^k tips; radii flow from the tips to the root in one backward pass of new contexts.
TEST(GoldenPipeModel, OneBackwardPassSumsThePipes) {
  const auto golden = golden_case("pipe_model");
  for (const auto& expected : golden["expected"]) {
    const Grammar grammar =
        Grammar::parse(R"(
#define e 2
#define k 10
#define r0 1
symbols: A(1) B(1)
axiom: A(k)
schedule: pipes
decomposition:
A(n) : n>0 --> B(0)[A(n-1)][A(n-1)]
A(n) --> B(r0)
group: pipes
B(r) >> [B(x)][B(y)] --> B((x^e+y^e)^(1/e))
)",
                       "pipes", {{"e", expected["e"]}, {"k", expected["k"]}, {"r0", expected["r0"]}});
    DeriveOptions options;
    options.steps = 1;
    const ModuleString string = grammar.derive(options);
    EXPECT_NEAR(string.parameters(0)[0], expected["r_base"].get<double>(),
                1e-6 * expected["r_base"].get<double>());
  }
}

}  // namespace
}  // namespace sunfleck::lsystem
