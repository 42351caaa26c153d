// Sky light in a grid of leaf area, against scenes known on paper.
#include "sim/growth/light_grid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

// A level sheet of leaf area index 2 between 5 and 6 m, over the whole period.
std::vector<LeafPlace> sheet(double lai, double width_m) {
  std::vector<LeafPlace> leaves;
  const double step = 0.1;
  for (double x = step / 2; x < width_m; x += step)
    for (double y = step / 2; y < width_m; y += step)
      for (double z = 5.05; z < 6; z += 0.1) leaves.push_back({{x, y, z}, lai * step * step / 10});
  return leaves;
}

TEST(LightGrid, OpenSkyIsOne) {
  LightGrid grid(LightGridOptions{});
  EXPECT_DOUBLE_EQ(grid.openness({0, 0, 1}), 1);
  EXPECT_DOUBLE_EQ(grid.openness({100, 0, 1}), 1);  // outside: nothing shades
}

// Below an endless layer of LAI 2 the 13 directions give sum w exp(-0.5 * 2 / cos); the exact integral over a
// uniform sky, 2 E3(1), is 0.219. Steps of a cell end within a cell: 3 % of the layer.
TEST(LightGrid, DimsBelowALayerByBeersLaw) {
  LightGridOptions options;
  options.period_m = 4;
  options.cell_m = 0.05 * 4;
  options.height_m = 10;
  LightGrid grid(options);
  grid.set_leaves(sheet(2, 4));
  const double expected =
      0.2 * std::exp(-1) + 0.4 * std::exp(-1 / std::sqrt(0.6)) + 0.4 * std::exp(-1 / std::sqrt(0.2));
  EXPECT_NEAR(grid.openness({0.3, 0.3, 1}), expected, 0.05 * expected);
  EXPECT_NEAR(expected, 0.219, 0.03);  // what 13 directions know of the sky
  EXPECT_DOUBLE_EQ(grid.openness({0.3, 0.3, 7}), 1);
}

// A high wall beside the point hides half of the sky: all directions with a part towards it.
TEST(LightGrid, AWallHidesItsSide) {
  LightGridOptions options;
  Box wall;
  wall.include(Vec3(1, -500, 0));
  wall.include(Vec3(2, 500, 2000));
  options.walls = {wall};
  LightGrid grid(options);
  // Left of the 12 slanting ones: 2 of 4, and of 8 those at 90, 135, 180, 225 and 270 degrees; the zenith.
  EXPECT_NEAR(grid.openness({0, 0, 1}), 0.2 + 2 * 0.1 + 5 * 0.05, 1e-12);
  EXPECT_EQ(grid.openness({1.5, 0, 1}), 0);  // inside it
}

// The same leaves seen in their period: a point a period further on has the same light.
TEST(LightGrid, ThePeriodRepeats) {
  LightGridOptions options;
  options.period_m = 3;
  LightGrid grid(options);
  const std::vector<LeafPlace> leaves{{{0.2, 0.1, 5}, 0.5}, {{1.0, -1.0, 4}, 0.4}, {{3.2, 0.1, 5}, 0.5}};
  grid.set_leaves(leaves);
  const double here = grid.openness({0.2, 0.1, 2});
  EXPECT_LT(here, 0.9);
  EXPECT_NEAR(grid.openness({3.2, 0.1, 2}), here, 1e-9);
  EXPECT_NEAR(grid.openness({0.2, -5.9, 2}), here, 1e-9);
}

TEST(LightGrid, RefusesImpossibleSizes) {
  for (const double wrong : {0.0, -1.0, std::nan(""), 1e9}) {
    LightGridOptions options;
    options.cell_m = wrong;
    EXPECT_THROW(LightGrid{options}, Error);
    options = {};
    options.period_m = wrong;
    EXPECT_THROW(LightGrid{options}, Error);
  }
  LightGridOptions many;
  many.cell_m = 0.01;
  EXPECT_THROW(LightGrid{many}, Error);
}

}  // namespace
}  // namespace sunfleck
