// Stand light where the answer is known on paper: Beer's law in even layers of small black leaves (cases
// "beer_*"), gaps over a sensor in a black well ("cone_gap_*"), the G-function of leaf angle families
// ("G_function_deWit").
#include <gtest/gtest.h>

#include <cmath>

#include "lighting/canopy/large_stand.h"
#include "lighting/canopy/leaf_projection.h"
#include "tests/lighting/canopy/stand_scenes.h"
#include "tests/lighting/trace/golden_cases.h"

namespace sunfleck::test {
namespace {

// As in the traced Beer tests: side / height below 0.01; one drawing of 20,000 leaves is off by up to 0.003
// (leaves that happen to hide behind each other), so that the tolerance is 0.005 absolute.
constexpr double kTolerance = 0.005;

Forest slab(double leaf_area_index, std::uint64_t seed) {
  constexpr std::size_t count = 20000;
  const double side = std::sqrt(leaf_area_index / static_cast<double>(count));
  Forest forest = forest_of(random_leaves(Crown::kBox, {0, 0, 1.5}, {0.5, 0.5, 1.0}, count, side, seed));
  forest.period = Period{{-0.5, -0.5}, {1, 1}};
  return forest;
}

StandLight light_of(const Forest& forest, StandSky sky, double rays) {
  StandSceneOptions options;
  options.ground_cell_m = 0.1;
  options.layer_m = 0.25;
  const StandScene scene(forest, options);
  StandLightRequest request;
  request.sky = std::move(sky);
  request.rays_per_cell = rays / static_cast<double>(scene.ground().count());
  request.potential = false;
  request.tree_relative_error = 0;
  return stand_light(scene, optics_of(forest, 0.0), request, {});
}

double intercepted(const StandLight& light) {
  return (light.plot.leaves[0] + light.plot.wood[0]) / light.plot.sent[0];
}

class BeerLayer : public ::testing::TestWithParam<const char*> {};

TEST_P(BeerLayer, SunAndSky) {
  const auto c = light_case(GetParam());
  const Forest forest = slab(c["inputs"]["LAI"], 1);
  for (const int zenith_deg : {0, 36, 60, 75}) {
    const std::string sun = "sza" + std::to_string(zenith_deg);
    const Vec3 to_sun = direction_from_azimuth_zenith(0.7, radians_from_degrees(zenith_deg));
    const StandLight light = light_of(forest, stand_sky(sun_source(to_sun), dark_source()), 100'000);
    EXPECT_NEAR(intercepted(light), c["expected"]["intercept_direct_" + sun].get<double>(), kTolerance)
        << sun;
    // Sunlit area has three times the noise of a count: 100,000 rays, 0.6 %.
    EXPECT_NEAR(light.trees.sunlit_leaf_area_m2.at(0, 0) / light.tree_leaf_area_m2[0],
                c["expected"]["sunlit_leaf_area_fraction_" + sun].get<double>(), 2.0 * kTolerance)
        << sun;
  }
  for (const SkyModel model : {SkyModel::kUniform, SkyModel::kStandardOvercast}) {
    const char* key = model == SkyModel::kUniform ? "intercept_diffuse_UOC" : "intercept_diffuse_SOC";
    const StandLight light = light_of(forest, stand_sky(dark_source(), sky_source(model, 12)), 200'000);
    EXPECT_NEAR(intercepted(light), c["expected"][key].get<double>(), kTolerance) << key;
  }
}
INSTANTIATE_TEST_SUITE_P(Cases, BeerLayer,
                         ::testing::Values("beer_spherical_LAI0.5", "beer_spherical_LAI2",
                                           "beer_spherical_LAI5"));

// Light at the foot of a layer with leaf area L above it: exp(-L / (2 cos)).
TEST(BeerProfile, FallsExponentially) {
  const Forest forest = slab(2.0, 2);
  const StandLight light = light_of(forest, stand_sky(sun_source({0, 0, 1}), dark_source()), 100'000);
  const LayerTables& layers = light.layers;
  double above = 0.0;
  for (std::size_t k = layers.leaf_area_m2.size(); k-- > 0;) {
    above += layers.leaf_area_m2[k];
    EXPECT_NEAR(layers.light_share.at(0, k), std::exp(-0.5 * above), 0.01) << k;
  }
  EXPECT_NEAR(light.plot.leaf_area_index, 2.0, 1e-3);
}

// Boxes of a tenth of a metre: the crown's own drawing is fitted, what is left is the boxes' randomness.
TEST(BeerLayer, SweptThroughBoxes) {
  Forest forest = slab(2.0, 3);
  LargeStandOptions options;
  options.voxel_m = 0.25;
  options.boxes_per_cell = 1;
  const LargeStandPrepared prepared = prepare_large_stand(forest, options, {});
  const auto c = light_case("beer_spherical_LAI2");
  const StandSky sky = stand_sky(dark_source(), sky_source(SkyModel::kUniform, 8));
  const LargeStandLight light = large_stand_light(forest, prepared, sky, {});
  // Between nodes of zenith, and where the crown alone has sides that its layer has not: 1.5 %.
  EXPECT_NEAR(light.trees[0] / light.incident[0], c["expected"]["intercept_diffuse_UOC"].get<double>(),
              0.015);
  EXPECT_NEAR(light.trees[0] + light.ground[0], light.incident[0], 1e-5 * light.incident[0]);
}

// A well of black leaves around the sensor: a wall of 720 plates.
Forest well(double radius_over_height) {
  constexpr int kPlates = 720;
  const double height = 2.0, radius = radius_over_height * height, top = 1.0 + height;
  std::vector<FoliageElement> plates;
  for (int k = 0; k < kPlates; ++k) {
    const double turn = 2.0 * kPi * k / kPlates;
    const Vec3 out(std::cos(turn), std::sin(turn), 0), along(-out.y, out.x, 0);
    plates.push_back(quad(radius * out + Vec3(0, 0, 0.5 * top),
                          radius * std::tan(kPi / kPlates) * 1.001 * along, {0, 0, 0.5 * top}));
  }
  return forest_of(std::move(plates));
}

class ConeGap : public ::testing::TestWithParam<const char*> {};

TEST_P(ConeGap, OpennessAndSiteFactors) {
  const auto c = light_case(GetParam());
  const std::string id = GetParam();
  const Forest forest = well(std::stod(id.substr(id.find('=') + 1)));
  const StandScene scene(forest, {});
  StandLightRequest request;
  request.sky = stand_sky(sun_source({0, 0, 1}), sky_source(SkyModel::kStandardOvercast, 24));
  request.sensors = {LightSensor{"centre", {0, 0}, 1.0, {0, 0, 1}}};
  request.canopy_views = true;
  request.canopy.zenith_steps = 360;
  request.canopy.azimuth_steps = 48;
  request.sensor_sky_rays = 64;
  request.rays_per_cell = 1;
  request.potential = false;
  request.tree_relative_error = 0;
  const StandLight light = stand_light(scene, optics_of(forest, 0.0), request, {});
  const double allowed = c["tolerance"]["abs"];
  EXPECT_NEAR(light.canopy[0].openness, c["expected"]["canopy_openness_solid_angle"].get<double>(), allowed);
  EXPECT_NEAR(light.canopy[0].sky_view_factor, c["expected"]["sky_view_factor_UOC"].get<double>(), allowed);
  // Patches are round for the rays and not for the sum: the edge of the gap is blurred by a patch (1 %).
  EXPECT_NEAR(light.sensors.indirect_site_factor[0], c["expected"]["indirect_site_factor_SOC"].get<double>(),
              0.005);
  EXPECT_EQ(light.sensors.direct_site_factor[0], 1.0);
}
INSTANTIATE_TEST_SUITE_P(Cases, ConeGap,
                         ::testing::Values("cone_gap_r/h=0.5", "cone_gap_r/h=1", "cone_gap_r/h=4"));

TEST(LeafProjection, OfOneInclination) {
  for (const double zenith : {0.0, 0.3, 0.9, 1.5}) {
    EXPECT_NEAR(mean_leaf_cosine(0.0, zenith), std::cos(zenith), 1e-12);
    EXPECT_NEAR(mean_leaf_cosine(0.5 * kPi, zenith), 2.0 / kPi * std::sin(zenith), 1e-12);
  }
  // Against the mean over azimuth itself.
  for (const double inclination : {0.2, 0.8, 1.3})
    for (const double zenith : {0.1, 0.7, 1.4}) {
      double mean = 0.0;
      constexpr int kSteps = 100000;
      for (int k = 0; k < kSteps; ++k)
        mean += std::abs(std::cos(inclination) * std::cos(zenith) +
                         std::sin(inclination) * std::sin(zenith) * std::cos(2.0 * kPi * k / kSteps)) /
                kSteps;
      EXPECT_NEAR(mean_leaf_cosine(inclination, zenith), mean, 1e-8);
    }
}

// Leaves at even steps of the cumulated angle density of de Wit's families.
TEST(LeafProjection, OfDeWitsFamilies) {
  const auto c = light_case("G_function_deWit");
  std::vector<double> zenith;
  for (const double deg : c["inputs"]["zenith_deg"]) zenith.push_back(radians_from_degrees(deg));
  const auto density = [](const std::string& family, double t) {
    if (family == "spherical") return std::sin(t);
    if (family == "planophile") return 2.0 / kPi * (1.0 + std::cos(2.0 * t));
    if (family == "erectophile") return 2.0 / kPi * (1.0 - std::cos(2.0 * t));
    return 2.0 / kPi * (1.0 - std::cos(4.0 * t));
  };
  for (const std::string family : {"spherical", "planophile", "erectophile", "plagiophile"}) {
    std::vector<FoliageElement> leaves;
    constexpr int kLeaves = 2000;
    for (int k = 0; k < kLeaves; ++k) {
      const double t = 0.5 * kPi * (k + 0.5) / kLeaves;
      const double side = std::sqrt(density(family, t) + 1e-9);
      const Basis b = basis_around({std::sin(t), 0, std::cos(t)});
      leaves.push_back(quad({0.0, 0.0, 1.0}, 0.01 * side * b.tangent, 0.01 * side * b.bitangent));
    }
    const std::vector<double> got = leaf_projection(forest_of(std::move(leaves)), zenith);
    for (std::size_t i = 0; i < zenith.size(); ++i)
      EXPECT_NEAR(got[i], c["expected"][family][i].get<double>(), 0.002) << family << " " << i;
  }
}

// Random leaves: what an LAI-2000 would infer is the leaf area, and the gaps are not clumped.
TEST(SensorCanopy, LeafAreaOfARandomLayer) {
  const Forest forest = slab(2.0, 4);
  const StandScene scene(forest, {});
  std::vector<LightSensor> sensors(24);
  for (std::size_t i = 0; i < sensors.size(); ++i)
    sensors[i] = {
        "", {-0.4 + 0.03 * static_cast<double>(i), 0.3 * std::sin(3.0 * static_cast<double>(i))}, 0.2};
  const auto canopy = sensor_canopy(scene, checked(sensors, scene), {}, {});
  double lai = 0.0, clumping = 0.0;
  for (const SensorCanopy& s : canopy) {
    lai += s.effective_lai_lai2000 / static_cast<double>(canopy.size());
    clumping += s.clumping / static_cast<double>(canopy.size());
  }
  // Welles and Norman's weights are 2 % high for spherical leaves; gaps of 1,000 rays are noisy logarithms.
  EXPECT_NEAR(lai, 2.0, 0.1);
  EXPECT_GT(clumping, 0.9);
  EXPECT_LE(clumping, 1.0);
}

}  // namespace
}  // namespace sunfleck::test
