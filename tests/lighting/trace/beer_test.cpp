// Canopies of many small black leaves with normals turned any way, against Beer's law (cases "beer_*" and
// "sphere_crown_*"). The law holds for leaves small against the canopy; here side / height < 0.01, which
// moves interception by less than the tolerance.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "lighting/trace/ray_scene.h"
#include "sim/base/random.h"
#include "tests/lighting/trace/golden_cases.h"
#include "tests/lighting/trace/scenes.h"

namespace sunfleck::test {
namespace {

constexpr double kTolerance = 0.005;  // absolute, of fractions, or 4 standard errors where that is more

// A period of 1 m x 1 m and 2 m height with 20,000 leaves, whose side is 0.5 to 1.6 cm.
Forest slab(double leaf_area_index, std::uint64_t seed) {
  constexpr std::size_t count = 20000;
  const double side = std::sqrt(leaf_area_index / static_cast<double>(count));
  Forest forest = forest_of(random_leaves(Crown::kBox, {0, 0, 1.5}, {0.5, 0.5, 1.0}, count, side, seed));
  forest.period = Period{{-0.5, -0.5}, {1, 1}};
  return forest;
}

ReferenceOptions rays(int per_face, int sun) {
  ReferenceOptions o;
  o.rays_per_face = per_face;
  o.sun_rays_per_element = sun;
  o.ground_cell_m = 0.05;
  return o;
}

// Fraction of the incident light that leaves take, and sunlit fraction of leaf area, averaged over seeds.
struct SlabLight {
  double intercepted = 0, intercepted_error = 0, sunlit = 0;
};
SlabLight slab_light(double leaf_area_index, const Illumination& light, const ReferenceOptions& options) {
  constexpr int kSeeds = 2;
  SlabLight mean;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Forest forest = slab(leaf_area_index, seed);
    const LightMap map = trace_light(forest, 0.0, light, options);
    expect_sound(map, forest);
    const EnergyBudget& b = map.bands[0].budget;
    mean.intercepted += b.absorbed_foliage_w / b.incident_w / kSeeds;
    const double error = map.bands[0].trees[0].absorbed_standard_error_w / b.incident_w / kSeeds;
    mean.intercepted_error = std::hypot(mean.intercepted_error, error);
    double sunlit = 0.0;
    for (const float f : map.sunlit_fraction) sunlit += f / static_cast<double>(map.sunlit_fraction.size());
    mean.sunlit += sunlit / kSeeds;
  }
  return mean;
}

double tolerance(const SlabLight& got) { return std::max(kTolerance, 4.0 * got.intercepted_error); }

class BeerSlab : public ::testing::TestWithParam<const char*> {};

// Black leaves: their own rays only set how many independent values the budget's standard error counts on.
TEST_P(BeerSlab, DirectLight) {
  const auto c = light_case(GetParam());
  for (const int zenith_deg : {0, 20, 36, 50, 60, 75}) {
    const std::string sun = "sza" + std::to_string(zenith_deg);
    const Illumination light =
        sunlight(direction_from_azimuth_zenith(0.7, radians_from_degrees(zenith_deg)), 1.0);
    const SlabLight got = slab_light(c["inputs"]["LAI"], light, rays(4, 8));
    EXPECT_NEAR(got.intercepted, c["expected"]["intercept_direct_" + sun].get<double>(), tolerance(got))
        << sun;
    EXPECT_NEAR(got.sunlit, c["expected"]["sunlit_leaf_area_fraction_" + sun].get<double>(), kTolerance)
        << sun;
  }
}

TEST_P(BeerSlab, DiffuseLight) {
  const auto c = light_case(GetParam());
  for (const SkyModel sky : {SkyModel::kUniform, SkyModel::kStandardOvercast}) {
    const char* key = sky == SkyModel::kUniform ? "intercept_diffuse_UOC" : "intercept_diffuse_SOC";
    const SlabLight got = slab_light(c["inputs"]["LAI"], skylight(1.0, sky), rays(8, 1));
    EXPECT_NEAR(got.intercepted, c["expected"][key].get<double>(), tolerance(got)) << key;
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, BeerSlab,
                         ::testing::Values("beer_spherical_LAI0.5", "beer_spherical_LAI1",
                                           "beer_spherical_LAI2", "beer_spherical_LAI3",
                                           "beer_spherical_LAI5"));

Forest ball(double crown_leaf_area_index, std::uint64_t seed) {
  const double side = 0.012;
  const auto count = static_cast<std::size_t>(std::lround(crown_leaf_area_index * kPi / (side * side)));
  return forest_of(random_leaves(Crown::kSphere, {0, 0, 2}, Vec3(1), count, side, seed));
}

// Black leaves in a ball of radius 1 take T = 1 - 2 (1 - (1 + K) e^-K) / K^2 of the light on its shadow.
TEST(BeerBall, SilhouetteAndCentralChord) {
  for (const char* id : {"sphere_crown_LAI1", "sphere_crown_LAI5"}) {
    const auto c = light_case(id);
    const double index = std::string(id).ends_with("1") ? 1.0 : 5.0;
    const Forest forest = ball(index, 3);
    ReferenceOptions o = rays(1, 16);
    o.ground = false;
    const LightMap map = trace_light(forest, 0.0, sunlight({1, 0.4, 1}, 1.0), o);
    const double expected = c["expected"]["intercepted_fraction_of_silhouette"];
    EXPECT_NEAR(map.bands[0].budget.absorbed_foliage_w / kPi, expected, kTolerance) << id;

    const RayScene scene(forest, {.ground = false});
    RandomStream random(9, 0, RandomPurpose::kTestScene);
    int through = 0;
    constexpr int kRays = 40000;  // standard error at most 0.0025
    for (int i = 0; i < kRays; ++i) {
      const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * kPi), r = std::sqrt(1 - z * z);
      const Vec3 d(r * std::cos(turn), r * std::sin(turn), z);
      through += scene.occluded(Vec3(0, 0, 2) - 2.0 * d, d) ? 0 : 1;
    }
    EXPECT_NEAR(through / static_cast<double>(kRays),
                c["expected"]["central_chord_transmittance"].get<double>(), 0.01)
        << id;
  }
}

}  // namespace
}  // namespace sunfleck::test
