// The grid method on scenes whose answer is known on paper: leaves alone under sun, sky and bright ground;
// Beer's law; the furnace, where nothing absorbs and every face must get exactly what the open sky brings.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "sim/forest/generated_scenes.h"
#include "tests/lighting/transport/grid_light.h"

namespace sunfleck::test {
namespace {

TEST(OneLeaf, LevelUnderUniformSkyGetsItAboveAndNothingBelow) {
  for (const int directions : {8, 14, 26}) {
    const Forest forest = forest_of({leaf_towards({0, 0, 1})}, {Leaf{0.25, 0.25}});
    const LightMap map = grid_light(forest, 0.0, skylight(100), {.directions = directions});
    const ElementLight& light = map.bands[0].elements[0];
    // Without its own shade to the second order of its depth in a cell, a = 0.13 in cells of 2 sides and up
    // to 0.23 along diagonals: a^3 / 6 remains.
    EXPECT_NEAR(light.front.sky_w_m2, 100.0, 0.25) << directions;
    EXPECT_EQ(light.back.sky_w_m2, 0.0f);
    EXPECT_EQ(light.front.direct_w_m2, 0.0f);
    EXPECT_NEAR(light.back.total(), 0.0, 0.05);
    EXPECT_NEAR(light.absorbed_w, 0.01 * 0.5 * (light.front.total() + light.back.total()),
                1e-5);  // 1 - r - t
  }
}

TEST(OneLeaf, FollowsTheCosineOfTheSun) {
  const Vec3 to_sun = direction_from_azimuth_zenith(radians_from_degrees(40), radians_from_degrees(50));
  for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(-0.3, 0.5, 0.2), to_sun}) {
    const Forest forest = forest_of({leaf_towards(normal)});
    const LightMap map = grid_light(forest, 0.0, sunlight(to_sun, 500));
    const double cosine = glm::dot(glm::normalize(normal), to_sun);
    EXPECT_NEAR(map.bands[0].elements[0].front.direct_w_m2, 500 * std::max(0.0, cosine), 1e-3);
    EXPECT_NEAR(map.bands[0].elements[0].back.direct_w_m2, 500 * std::max(0.0, -cosine), 1e-3);
    EXPECT_EQ(map.sunlit_fraction[0], 1.0f);
  }
}

TEST(OneLeaf, SeesTheSunOnTheGround) {
  // Small and high above the ground: its back faces ground of radiance 0.2 (100 + 800 cos 60) / pi.
  const Forest forest = forest_of({leaf_towards({0, 0, 1}, 0.01, {0, 0, 3})});
  const Vec3 to_sun = direction_from_azimuth_zenith(1.0, radians_from_degrees(60));
  const LightMap map = grid_light(forest, 0.2, sunlight(to_sun, 800, 100));
  EXPECT_NEAR(map.bands[0].elements[0].back.scattered_w_m2, 0.2 * (100 + 800 * 0.5), 1.5);
  EXPECT_EQ(map.bands[0].elements[0].back.sky_w_m2, 0.0f);
}

TEST(OneShoot, HasNeedlesThatFaceEverywhere) {
  // A thin shoot over white ground: each face of a needle gets E / 4 of a beam and half its light from above.
  const Forest forest = forest_of({shoot({0, 0, 1}, {0.05, 0, 0}, 0.02, 1e-8)});
  const ElementLight light = grid_light(forest, 1.0, sunlight({0.2, 0.1, 1}, 400, 100)).bands[0].elements[0];
  EXPECT_NEAR(light.front.direct_w_m2, 100.0, 1e-3);
  EXPECT_NEAR(light.back.direct_w_m2, 100.0, 1e-3);
  EXPECT_NEAR(light.front.sky_w_m2, 50.0, 0.1);
}

TEST(Layer, SkyAndSunFollowBeer) {
  // Black leaves, G = 1/2: sunlit share (1 - exp(-K)) / K with K = LAI / (2 cos z); mean irradiance of a leaf
  // (both faces) by the uniform sky (1 - 2 E3(LAI / 2)) / LAI: what does not reach the ground is taken.
  // E3(1.5) = 0.056739 (Abramowitz and Stegun, table 5.4).
  const Forest forest = generated_layer({.lai = 3, .leaves = 20000, .seed = 2});
  const OpticsTable optics(forest, {.bands = {"VIS"}, .soil_albedo = {0.0}, .overrides = {{"*", "VIS", {}}}});
  for (const int zenith_deg : {0, 36, 60, 75}) {
    const Vec3 to_sun = direction_from_azimuth_zenith(1.2, radians_from_degrees(zenith_deg));
    const LightMap map = grid_light_map(forest, optics, sunlight(to_sun, 1, 1), {}, {});
    double sunlit = 0.0;
    for (const float s : map.sunlit_fraction) sunlit += s / 20000.0;
    const double k = 1.5 / std::cos(radians_from_degrees(zenith_deg));
    EXPECT_NEAR(sunlit, (1 - std::exp(-k)) / k, 0.01) << zenith_deg;
    const double expected = (1 - 2 * 0.056739) / 3;
    EXPECT_NEAR(mean_of(map.bands[0], &FaceLight::sky_w_m2) / expected, 1.0, 0.02);
    EXPECT_EQ(mean_of(map.bands[0], &FaceLight::scattered_w_m2), 0.0);
    EXPECT_LT(std::abs(map.bands[0].budget.residual_w / map.bands[0].budget.incident_w), 0.015) << zenith_deg;
  }
}

// ---- furnace
// -----------------------------------------------------------------------------------------------

void expect_all_lit_by_one(const LightMap& map, double tolerance) {
  double worst = 0.0;
  for (const ElementLight& e : map.bands[0].elements)
    for (const FaceLight& f : {e.front, e.back}) worst = std::max(worst, std::abs(f.total() - 1.0));
  std::cout << "furnace: worst face off by " << worst << ", " << map.provenance.settings.back().second
            << " iterations\n";
  EXPECT_LT(worst, tolerance);
}

GridOptions tight(int directions) {
  return {.directions = directions, .cell_m = 0, .convergence = 1e-7, .max_iterations = 2000};
}
// Floats, summed over some hundred orders.
constexpr double kRounding = 1e-4;
// In a period leaves scatter from the mean light of their cell, a difference of what enters and leaves it:
// single precision of thin cells.
constexpr double kRoundingOfMeans = 3e-4;

TEST(Furnace, RandomCrownOverWhiteGround) {
  const Forest forest =
      forest_of(random_leaves(Crown::kSphere, {0, 0, 2}, Vec3(1), 2000, 0.06, 5), {Leaf{0.5, 0.5}});
  for (const int directions : {8, 14, 26})
    expect_all_lit_by_one(grid_light(forest, 1.0, skylight(1.0), tight(directions)), kRounding);
}

TEST(Furnace, PeriodicCrownOnASlope) {
  Forest forest =
      forest_of(random_leaves(Crown::kSphere, {0, 0, 2}, Vec3(1), 2000, 0.06, 5), {Leaf{0.6, 0.4}});
  forest.period = Period{{-0.8, -0.7}, {1.6, 1.5}};
  for (const double slope : {0.0, 0.3}) {
    forest.terrain = {.elevation_m = 0, .slope_rad = slope, .aspect_rad = 1.0};
    // On a slope the sky does not fill the hemisphere of the ground: level faces lose what lies below the
    // horizon. Only the flat furnace is even.
    const LightMap map = grid_light(forest, 1.0, skylight(1.0), tight(26));
    if (slope == 0.0) expect_all_lit_by_one(map, kRoundingOfMeans);
    EXPECT_LT(map.bands[0].budget.absorbed_foliage_w, 1e-6 * map.bands[0].budget.incident_w);
  }
}

// Discs, triangles, leaves larger than cells, shoots, wood and its mesh, unlike faces, turned and scaled
// copies.
TEST(Furnace, EverythingAtOnce) {
  Forest forest =
      forest_of(random_leaves(Crown::kSphere, {0, 0, 2}, Vec3(1), 300, 0.15, 5), {Leaf{0.7, 0.3, 1.0}});
  Prototype& tree = forest.prototypes[0];
  for (int i = 0; i < 20; ++i) {
    tree.foliage.push_back(disc({0.1 * i - 1, 0.3, 2}, {0.3, 0.1 * i - 1, 1}, 0.1));
    tree.foliage.push_back(shoot({0.1 * i - 1, -0.3, 2.2}, {0.1, 0.05, 0}, 0.04, 0.03));
    tree.foliage.push_back(triangle({0.1 * i - 1, 0, 1}, {0.1 * i - 0.8, 0.1, 1}, {0.1 * i - 1, 0.2, 1.1}));
  }
  tree.foliage.push_back(quad({0, 0, 2}, {0.5, 0, 0}, {0, 0.4, 0.1}));
  tree.wood.push_back({{0, 0, 0}, {0, 0, 1}, 0.1f, 0.05f, 0});
  tree.wood_mesh.push_back({{0, 0, 2.5f}, {0.3f, 0, 2.5f}, {0, 0.3f, 2.6f}, 0});
  forest.instances = {{{0, 0, 0}, {}, 0.0f, 1.0f, {}}, {{1.5, 0.4, 0}, {}, 2.0f, 0.6f, {}}};
  for (const bool periodic : {false, true}) {
    if (periodic) forest.period = Period{{-1, -1}, {3, 2}};
    expect_all_lit_by_one(grid_light(forest, 1.0, skylight(1.0), tight(26)), kRounding);
  }
}

TEST(Furnace, PeriodThatAbsorbsNothingGivesAllSunBack) {
  // r + t = 1 over white ground: what comes in goes out, whatever its way.
  Forest forest = generated_layer({.lai = 2, .leaves = 5000, .seed = 3});
  forest.materials[0].bands = {{"B", 0.6, 0.4, 1.0}};
  const LightMap map = grid_light(forest, 1.0, sunlight({0.4, 0.3, 0.8}, 1000, 0), tight(26));
  const EnergyBudget& b = map.bands[0].budget;
  std::cout << "sun on a white layer: " << b.escaped_w / b.incident_w << " comes back\n";
  EXPECT_NEAR(b.escaped_w / b.incident_w, 1.0, 0.02);
  EXPECT_NEAR(b.absorbed_foliage_w + b.absorbed_ground_w + b.absorbed_wood_w, 0.0, 1e-3 * b.incident_w);
}

}  // namespace
}  // namespace sunfleck::test
