// Does the error bar mean what it says: over scenes, methods, bands and seeds of the probes, the 95 %
// intervals of bias, element RMS and RMS of trees or layers must contain the true error at least 93 times in
// 100. Few seeds here; tests/bench/plan/coverage_bench.cpp counts with many.
#include <gtest/gtest.h>

#include "tests/lighting/plan/covered_scene.h"

namespace sunfleck::test {
namespace {

// Bars of one seed share their probes: 20 x 4 independent sets, one sd 2.4 %. A true coverage of 95 % fails
// these bounds, three sd below it, once in a thousand.
constexpr int kSeeds = 20;
constexpr double kLeast = 0.95 - 3 * 0.024;

TEST(ErrorBars, CoverTheTrueError) {
  Coverage all;
  int groups_inside = 0, group_bars = 0;
  for (const Forest& forest : scenes_for_error_bars()) {
    const CoveredScene scene(forest);
    all.add(scene.count({}, kSeeds));
    const auto [inside, bars] = scene.count_groups(kSeeds);
    groups_inside += inside;
    group_bars += bars;
  }
  EXPECT_GE(all.inside_bias, kLeast * all.bars);
  EXPECT_GE(all.inside_rms, kLeast * all.bars);
  EXPECT_GE(groups_inside, kLeast * group_bars);
}

}  // namespace
}  // namespace sunfleck::test
