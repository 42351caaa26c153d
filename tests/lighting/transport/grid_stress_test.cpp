// Scenes at the edges of what can be asked: every value stays finite and >= 0 (grid_light_map() checks that
// itself by find_violation()), no face gets more than the sources can bring, and the obvious limits hold.
#include <gtest/gtest.h>

#include <cmath>

#include "lighting/base/summaries.h"
#include "sim/forest/generated_scenes.h"
#include "tests/lighting/transport/grid_light.h"

namespace sunfleck::test {
namespace {

LightMap sound(const Forest& forest, const Illumination& light, double soil = 0.3,
               const GridOptions& options = {}) {
  const LightMap map = grid_light(forest, soil, light, options);
  EXPECT_EQ(find_violation(map, ForestIndex(forest)), "");
  // A beam of 1000, a sky of 1000, ground below: multiple bounces between white leaves add at most the
  // furnace's even light.
  for (const ElementLight& e : map.bands[0].elements)
    for (const FaceLight& f : {e.front, e.back}) EXPECT_LT(f.total(), 4000.0f);
  return map;
}

std::vector<Vec3> suns() {
  std::vector<Vec3> all{{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0.2, 0.9, 0.1}};
  for (const double elevation : {0.0, 1e-9, -1e-9, 1e-3})
    for (const double turn : {0.0, 0.5 * kPi, 1.0})
      all.push_back(
          {std::cos(elevation) * std::cos(turn), std::cos(elevation) * std::sin(turn), std::sin(elevation)});
  return all;
}

TEST(Stress, SunsAlongAxesAndAtTheHorizon) {
  Forest crown =
      forest_of(random_leaves(Crown::kSphere, {0, 0, 2}, Vec3(1), 800, 0.08, 5), {Leaf{0.45, 0.45}});
  Forest layer = generated_layer({.lai = 2, .leaves = 800});
  layer.materials[0].bands = {{"B", 0.45, 0.45, 0.3}};
  for (const Vec3& to_sun : suns()) {
    for (const int directions : {8, 14, 26}) {
      sound(crown, sunlight(to_sun, 1000, 1000), 0.3, {.directions = directions});
      sound(layer, sunlight(to_sun, 1000, 1000), 0.3, {.directions = directions});
    }
  }
}

TEST(Stress, OneLeafOfAnySizeAnywhere) {
  for (const double side : {1e-3, 0.1, 1e3})
    for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(1, 1, 1), Vec3(1e-9, 0, 1)})
      for (const double away : {0.0, 1e6}) {
        Forest forest = forest_of({leaf_towards(normal, side, {0, 0, side})}, {Leaf{0.5, 0.5}});
        forest.instances[0].position_m = {away, away, 0};
        sound(forest, sunlight({0, 0, 1}, 1000, 1000), 1.0);
      }
}

TEST(Stress, EdgeOnLeafGetsNoBeam) {
  const Forest forest = forest_of({leaf_towards({1, 0, 0})}, {Leaf{0.5, 0.5}});
  const LightMap map = sound(forest, sunlight({0, 0, 1}, 1000, 0), 0.0);
  EXPECT_NEAR(map.bands[0].elements[0].front.total(), 0.0, 1e-3);
  EXPECT_NEAR(map.bands[0].elements[0].back.total(), 0.0, 1e-3);
}

TEST(Stress, FlatCrown) {
  std::vector<FoliageElement> leaves;
  for (int i = 0; i < 400; ++i)
    leaves.push_back(leaf_towards({0, 0, 1}, 0.1, {0.1 * (i % 20), 0.1 * (i / 20), 1}));
  const Forest forest = forest_of(leaves, {Leaf{0.45, 0.45}});
  const LightMap map = sound(forest, sunlight({0.1, 0.2, 1}, 1000, 1000), 0.3);
  for (const ElementLight& e : map.bands[0].elements) ASSERT_GT(e.front.total(), e.back.total());
}

TEST(Stress, CoincidentAndBuriedLeaves) {
  std::vector<FoliageElement> leaves(500, leaf_towards({0.3, 0.2, 1}));
  leaves.push_back(leaf_towards({0, 0, 1}, 0.1, {0, 0, -1}));
  const Forest forest = forest_of(leaves, {Leaf{0.45, 0.45}});
  const LightMap map = sound(forest, sunlight({0.1, 0.2, 1}, 1000, 1000));
  EXPECT_EQ(map.bands[0].elements.back().front.total(), 0.0f);
  EXPECT_EQ(map.bands[0].elements.back().back.total(), 0.0f);
}

TEST(Stress, DepthsFromNothingToWall) {
  // The same crown with leaves of 1e-5 m to 1 m: optical depths from 1e-8 to 100; thin ones see open light.
  for (const double side : {1e-5, 1e-3, 0.1, 1.0}) {
    for (const double albedo : {0.0, 0.5, 1.0}) {
      const Forest forest = forest_of(random_leaves(Crown::kSphere, {0, 0, 2}, Vec3(1), 500, side, 5),
                                      {Leaf{0.5 * albedo, 0.5 * albedo}});
      const LightMap map = sound(forest, sunlight({0.1, 0.2, 1}, 1000, 1000), albedo, {.cell_m = 0.2});
      if (side > 1e-4) continue;
      for (const ElementLight& e : map.bands[0].elements) {
        ASSERT_NEAR(e.front.direct_w_m2 + e.back.direct_w_m2 > 0 ? map.sunlit_fraction[0] : 1.0, 1.0, 1e-4);
        ASSERT_NEAR(e.front.sky_w_m2 + e.back.sky_w_m2, 1000.0, 250.0);  // sectors straddle the horizon
      }
    }
  }
}

TEST(Stress, LeavesOfNoAreaAndNarrowPeriods) {
  std::vector<FoliageElement> leaves =
      random_leaves(Crown::kBox, {0.5, 0.5, 5}, Vec3(0.5, 0.5, 5), 400, 0.05, 3);
  leaves.push_back({.centre_m = {0.5f, 0.5f, 1}, .half_u_m = {0, 0, 0}, .half_v_m = {0, 0, 0}, .area_m2 = 0});
  Forest forest = forest_of(leaves, {Leaf{0.5, 0.5}});
  sound(forest, sunlight({0.3, 0.2, 1}, 1000, 1000));
  for (const double width : {1.0, 0.05}) {  // the second narrower than a cell
    forest.period = Period{{0, 0}, {width, width}};
    sound(forest, sunlight({0.3, 0.2, 1}, 1000, 1000));
  }
}

TEST(Stress, SteepGround) {
  Forest forest =
      forest_of(random_leaves(Crown::kSphere, {0, 0, 3}, Vec3(1), 800, 0.08, 5), {Leaf{0.45, 0.45}});
  for (const double slope_deg : {30.0, 60.0, 80.0}) {
    forest.terrain = {.elevation_m = 0, .slope_rad = radians_from_degrees(slope_deg), .aspect_rad = 0.7};
    for (const bool periodic : {false, true}) {
      forest.period.reset();
      if (periodic) forest.period = Period{{-1, -1}, {2, 2}};
      sound(forest, sunlight({0.3, 0.2, 1}, 1000, 1000));
    }
  }
}

}  // namespace
}  // namespace sunfleck::test
