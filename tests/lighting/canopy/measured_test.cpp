// The measured stand Cloture20: crowns as measured, evenly filled with random leaves, plot repeated, a
// growing season from the monthly table; nothing fitted. Prints what it finds; what it asserts is that
// homogeneous crowns do as well as they have been found to (RMSE 0.083, and the R package's 0.073 beside it).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "lighting/canopy/stand_light.h"
#include "tests/bench/canopy/measured_stand.h"
#include "tests/bench/canopy/season.h"
#include "tests/support/golden.h"

namespace sunfleck::test {
namespace {

TEST(Cloture20, SeasonAtTheSensors) {
  const auto folder = shared_data("stands/cloture20");
  if (!folder) GTEST_SKIP() << "measured stands are not here";
  const bench::MeasuredStand stand = bench::measured_stand(*folder, 1000, true);
  StandSceneOptions map;
  map.map_lo_m = stand.map_lo_m;
  map.map_hi_m = stand.map_hi_m;
  const StandScene scene(stand.forest, map);
  StandLightRequest request;
  request.sky = bench::season_sky(*folder / "monthly_radiation.csv", {.by_month = false});
  request.sensors = stand.sensors;
  const OpticsTable optics(stand.forest, {{"PAR"}, {0.1}, {}});
  const StandLight light = stand_light(scene, optics, request, {});
  const bench::Agreement a = bench::agreement(light.sensors.gap_light_index, stand.pacl);
  std::printf("PACL of %zu sensors: RMSE %.3f bias %+.3f correlation %.2f spread %.3f\n", stand.pacl.size(),
              a.rmse, a.bias, a.correlation, a.spread);
  ASSERT_EQ(stand.pacl.size(), 16u);
  EXPECT_LT(a.rmse, 0.09);  // 0.083 and the noise of one drawing of leaves, 0.005
  EXPECT_LT(std::abs(a.bias), 0.025);
  EXPECT_GT(a.correlation, 0.6);
  // Leaves at 0.5 m2/m3 in the crowns: 35,238 m2 on a hectare.
  EXPECT_NEAR(light.plot.leaf_area_index, 3.52, 0.02);
  const PlotTables& p = light.plot;
  EXPECT_NEAR(p.leaves[0] + p.wood[0] + p.ground[0], p.sent[0], 1e-5 * p.sent[0]);
  // A tree that competes gets less than alone, within the noise of both counts.
  for (std::size_t t = 0; t < light.tree_ids.size(); ++t)
    EXPECT_LT(light.trees.light_competition.at(0, t),
              1.0 + 4.0 * light.trees.light_competition.error_at(0, t));
}

}  // namespace
}  // namespace sunfleck::test
