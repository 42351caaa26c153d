// Does the error bar mean what it says: over scenes, methods, bands and seeds of the probes, the 95 %
// intervals of bias, element RMS and RMS of trees or layers must contain the true error at least 93 times in
// 100. tests/bench/plan/coverage_bench.cpp counts with more seeds.
#include <gtest/gtest.h>

#include "tests/lighting/plan/covered_scene.h"

namespace sunfleck::test {
namespace {

// Bars of one seed share their probes: 60 x 4 independent sets, one sd of a coverage 1.4 %. Trees and layers
// are drawn anew for each seed, which takes longer.
constexpr int kSeeds = 60, kGroupSeeds = 20;
constexpr double kLeast = 0.93;

TEST(ErrorBars, CoverTheTrueErrorAtLeast93TimesIn100) {
  Coverage all;
  int groups_inside = 0, group_bars = 0;
  for (const Forest& forest : scenes_for_error_bars()) {
    const CoveredScene scene(forest);
    all.add(scene.count({}, kSeeds));
    const auto [inside, bars] = scene.count_groups(kGroupSeeds);
    groups_inside += inside;
    group_bars += bars;
  }
  std::printf("bias %d, rms %d of %d; trees or layers %d of %d\n", all.inside_bias, all.inside_rms, all.bars,
              groups_inside, group_bars);
  EXPECT_GE(all.inside_bias + all.inside_rms, kLeast * 2 * all.bars);
  EXPECT_GE(groups_inside, kLeast * group_bars);
}

}  // namespace
}  // namespace sunfleck::test
