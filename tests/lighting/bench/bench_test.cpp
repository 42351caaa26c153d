// The yardstick itself: error figures of estimates whose error is known, fronts, exponents, scenes.
#include <gtest/gtest.h>

#include <cmath>

#include "lighting/bench/bench_scenes.h"
#include "lighting/bench/benchmark_tables.h"
#include "lighting/bench/cost_growth.h"
#include "sim/base/error.h"
#include "sim/forest/generated_scenes.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

BandLightMap even_light(std::size_t elements, float direct, float sky) {
  BandLightMap map;
  map.elements.resize(elements);
  for (ElementLight& e : map.elements) e.front = {direct, sky, 0};
  map.standard_error_w_m2.assign(elements, 0.0f);
  return map;
}

TEST(ErrorFigures, OfAConstantFactorAreThatFactor) {
  const ErrorGroups groups{{0, 0, 1, 2}, {0, 1, 1, 5}};
  const BandLightMap truth = even_light(4, 80, 20), estimate = even_light(4, 88, 22);
  const ErrorFigures f = compare(groups, estimate, truth);
  for (const double figure : {f.bias, f.element_rms, f.cell_rms, f.class_rms, f.diffuse_rms})
    EXPECT_NEAR(figure, 0.1, 1e-7);
}

TEST(ErrorFigures, ScatterWithinACellCancelsInItsMean) {
  const ErrorGroups groups{{0, 0, 1, 1}, {0, 1, 0, 1}};
  const BandLightMap truth = even_light(4, 100, 0);
  BandLightMap estimate = truth;
  for (std::size_t i = 0; i < 4; ++i) estimate.elements[i].front.direct_w_m2 += i % 2 == 0 ? 30.0f : -30.0f;
  const ErrorFigures f = compare(groups, estimate, truth);
  EXPECT_NEAR(f.bias, 0, 1e-12);
  EXPECT_NEAR(f.element_rms, 0.3, 1e-7);
  EXPECT_NEAR(f.cell_rms, 0, 1e-12);
  EXPECT_NEAR(f.class_rms, 0.3, 1e-7);  // classes split them the other way
}

TEST(ErrorFigures, TheTruthsOwnNoiseIsTakenOut) {
  const ErrorGroups groups{{0, 0}, {0, 0}};
  BandLightMap truth = even_light(2, 100, 0);
  truth.standard_error_w_m2 = {6, 6};
  const BandLightMap estimate = even_light(2, 110, 0);
  EXPECT_NEAR(compare(groups, estimate, truth).element_rms, 0.08, 1e-7);  // sqrt(.10^2 - .06^2)
}

BenchmarkRow row(const std::string& method, double cpu_s, double error) {
  BenchmarkRow r;
  r.scene = "s", r.band = "PAR", r.method = method, r.knob = "say \"a\"", r.cpu_s = cpu_s;
  r.error.element_rms = error;
  return r;
}

TEST(ParetoFront, KeepsWhatNoOtherBeatsInBoth) {
  const std::vector<BenchmarkRow> rows = {row("a", 1, 0.3), row("b", 2, 0.4), row("c", 3, 0.1),
                                          row("d", 0.5, 0.5), row("e", 4, 0.1)};
  EXPECT_EQ(pareto_front(rows, "s", "PAR"), (std::vector<std::size_t>{3, 0, 2}));
  EXPECT_TRUE(pareto_front(rows, "s", "NIR").empty());
}

TEST(BenchmarkCsv, HasAsManyFieldsAsNames) {
  MachineFacts machine = machine_facts();
  machine.processor = "Some, processor";
  const std::string csv = benchmark_csv({row("a", 1, 0.3)}, 2, machine);
  const auto fields = [](const std::string& line) {
    bool inside = false;
    int count = 1;
    for (const char c : line) {
      if (c == '"') inside = !inside;
      count += !inside && c == ',';
    }
    return count;
  };
  const std::size_t end = csv.find('\n');
  EXPECT_EQ(fields(csv.substr(0, end)), fields(csv.substr(end + 1)));
  EXPECT_FALSE(machine.commit.empty());
}

TEST(Growth, ExponentOfAPowerLawIsItsExponent) {
  std::vector<GrowthRow> rows;
  for (const double n : {10.0, 100.0, 1000.0})
    rows.push_back({.method = "m", .knob = "k", .count = n, .cpu_s = 2e-3 * std::pow(n, 1.25)});
  EXPECT_NEAR(growth_exponent(rows, "m", "k", 1), 1.25, 1e-12);
  EXPECT_TRUE(std::isnan(growth_exponent(rows, "m", "k", 500)));
}

TEST(Growth, MeasuresTimeAndErrorTogether) {
  GrowthPlan plan{.steps = method_ladders("grid"), .most_elements = 1000};
  const auto rows = cost_growth(GrowthKind::kLeaves, plan, {});
  ASSERT_EQ(rows.size(), plan.steps.size());  // one count fits
  for (const GrowthRow& r : rows) {
    EXPECT_GT(r.cpu_s, 0);
    EXPECT_LE(r.bias_low, r.bias);
    EXPECT_LE(r.bias, r.bias_high);
    EXPECT_GT(r.element_rms, 0);
    EXPECT_LT(std::fabs(r.bias), 0.3);
  }
}

TEST(BenchScenes, AreAllMadeAndNamed) {
  const auto scenes = bench_scenes(1, test::source_dir() / "configs" / "species");
  for (const BenchScene& scene : choose_scenes(scenes, "all")) {
    const Forest forest = scene.make({});
    EXPECT_EQ(forest.name, scene.name);
    EXPECT_NO_THROW(validate(forest)) << scene.name;
    EXPECT_GT(ForestIndex(forest).element_count(), 500u) << scene.name;
  }
  EXPECT_EQ(choose_scenes(scenes, "quick").size(), 3u);
  EXPECT_THROW(choose_scenes(scenes, "moon"), Error);
  EXPECT_THROW(choose_scenes(scenes, ""), Error);
}

TEST(ErrorAgainstTime, CheapScenesGiveSaneRows) {
  Forest forest = generated_crown({.leaves = 600});
  BenchmarkPlan plan{64, 2, {1}, method_ladders("reference,grid,envelope")};
  std::vector<std::string> refused;
  const auto rows = error_against_time(forest, bench_light(forest, "all"), plan, refused, {});
  EXPECT_EQ(rows.size(), 4 * plan.steps.size());
  EXPECT_TRUE(refused.empty());
  for (const BenchmarkRow& r : rows) {
    EXPECT_GT(r.wall_s, 0);
    EXPECT_GT(r.peak_memory_bytes, 1u << 20);
    EXPECT_TRUE(std::isfinite(r.error.class_rms));
  }
  EXPECT_THROW(bench_light(forest, "UV"), Error);
}

}  // namespace
}  // namespace sunfleck
