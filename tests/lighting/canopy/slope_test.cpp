// Stand light on slopes where the answer is known on paper, and against traced light.
//
// A plane falls by the angle b towards its aspect, n its unit normal. Sunlight of 1 on a facing plane brings
// dot(s, n) / n.z to each m2 of map (seen from above). A uniform sky reaches a receiver on the plane from the
// part of the hemisphere above both the horizon and the plane: (1 + cos b) / 2 of the open level plane's
// light, whether the receiver lies level or along the plane (Liu and Jordan 1960). A layer of leaves parallel
// to the plane with leaf area L per m2 of map and normals that point everywhere lets exp(-L / (2 f)) through,
// f = dot(s, n) / n.z: the way through it is its thickness h n.z over dot(s, n).
#include <gtest/gtest.h>

#include <cmath>

#include "lighting/canopy/large_stand.h"
#include "tests/lighting/canopy/stand_scenes.h"

namespace sunfleck::test {
namespace {

struct Slope {
  double slope_deg, aspect_deg;
};
Terrain terrain_of(const Slope& s) {
  return {2.0, radians_from_degrees(s.slope_deg), radians_from_degrees(s.aspect_deg)};
}

double facing(const Terrain& ground, const Vec3& sun) {
  return std::max(0.0, glm::dot(sun, ground.normal()) / ground.normal().z);
}

Vec3 sun_at(double azimuth_deg, double zenith_deg) {
  return direction_from_azimuth_zenith(radians_from_degrees(azimuth_deg), radians_from_degrees(zenith_deg));
}

StandLightRequest request(StandSky sky, double rays_per_cell) {
  StandLightRequest r;
  r.sky = std::move(sky);
  r.rays_per_cell = rays_per_cell;
  r.tree_relative_error = 0;
  r.potential = false;
  return r;
}

class OnASlope : public ::testing::TestWithParam<Slope> {};

// One leaf far up in the corner of a map of 20 m: the slope is bare where it is looked at.
Forest bare(const Terrain& terrain) {
  Forest forest = forest_of({quad({0, 0, 1}, {0.01, 0, 0}, {0, 0.01, 0})});
  forest.terrain = terrain;
  forest.instances[0].position_m = {9.9, 9.9, terrain.height_at(9.9, 9.9)};
  return forest;
}

StandSceneOptions map_of_20_m() {
  StandSceneOptions o;
  o.ground_cell_m = 5;
  o.map_lo_m = Vec2(-10, -10);
  o.map_hi_m = Vec2(10, 10);
  return o;
}

TEST_P(OnASlope, BareGroundGetsTheBeamOfAnInclinedPlane) {
  const Terrain terrain = terrain_of(GetParam());
  const Forest forest = bare(terrain);
  const StandScene scene(forest, map_of_20_m());
  for (const double azimuth : {0.0, 130.0, 250.0})
    for (const double zenith : {0.0, 40.0, 75.0}) {
      const Vec3 sun = sun_at(azimuth, zenith);
      const StandLight light = stand_light(scene, optics_of(forest, 0.0),
                                           request(stand_sky(sun_source(sun), dark_source()), 400), {});
      // The cell in the middle: no shadow of the leaf. Rays are stratified: their count per cell strays by
      // about the cell's rim, 2 sqrt(400) of 400 at most.
      const std::size_t cell = scene.ground().cell_at(0.1, 0.1);
      const double want = facing(terrain, sun);
      EXPECT_NEAR(light.ground.total.at(0, cell), want, 0.1 * want) << azimuth << " " << zenith;
      // All cells together, less the leaf's shadow of 4 cm2.
      EXPECT_NEAR(light.plot.ground[0], 400.0 * want, 0.01 * 400.0 * want + 1e-9) << azimuth << " " << zenith;
    }
}

TEST_P(OnASlope, SensorsSeeTheSkyAbovePlaneAndHorizon) {
  const Terrain terrain = terrain_of(GetParam());
  const Forest forest = bare(terrain);
  const StandScene scene(forest, map_of_20_m());
  StandLightRequest r = request(stand_sky(dark_source(), sky_source(SkyModel::kUniform, 16)), 1);
  r.sensors = {LightSensor{"level", {0, 0}, 0.5, {0, 0, 1}},
               LightSensor{"along", {1, 2}, 0.5, terrain.normal()}};
  r.sensor_sky_rays = 64;
  const StandLight light = stand_light(scene, optics_of(forest, 0.0), r, {});
  const double want = 0.5 * (1.0 + std::cos(terrain.slope_rad));
  // 16 rings of patches, round for the rays: 0.5 % where the plane cuts through them. The receiver along the
  // plane takes a patch by the cosine of its middle, and the slope's edge runs through those of least cosine.
  EXPECT_NEAR(light.sensors.diffuse.at(0, 0), want, 0.005);
  EXPECT_NEAR(light.sensors.diffuse.at(0, 1), want, 0.005);
  EXPECT_NEAR(light.sensors.open_diffuse.at(0, 0), 1.0, 1e-6);
  EXPECT_NEAR(light.sensors.pacl_diffuse.at(0, 0), want, 0.005);  // the slope itself hides sky
}

// A layer of one metre above the slope, its leaves moved up and down with the ground.
Forest slab(const Terrain& terrain, double leaf_area_index, const Leaf& leaf) {
  constexpr std::size_t count = 20000;
  const double side = std::sqrt(leaf_area_index / static_cast<double>(count));
  auto leaves = random_leaves(Crown::kBox, {0, 0, 1.5}, {0.5, 0.5, 1.0}, count, side, 11);
  for (FoliageElement& e : leaves)
    e.centre_m.z += static_cast<float>(terrain.height_at(e.centre_m.x, e.centre_m.y) - terrain.elevation_m);
  Forest forest = forest_of(std::move(leaves), {leaf});
  forest.terrain = terrain;
  forest.instances[0].position_m = {0, 0, terrain.elevation_m};
  forest.period = Period{{-0.5, -0.5}, {1, 1}};
  return forest;
}

StandLight light_of(const Forest& forest, StandSky sky, double rays, double soil = 0.0) {
  StandSceneOptions options;
  options.ground_cell_m = 0.25;
  const StandScene scene(forest, options);
  return stand_light(scene, optics_of(forest, soil), request(std::move(sky), rays / 16), {});
}

TEST_P(OnASlope, LayerParallelToItFollowsBeer) {
  constexpr double kLai = 2.0;
  const Terrain terrain = terrain_of(GetParam());
  const Forest forest = slab(terrain, kLai, {});
  for (const double azimuth : {20.0, 200.0})
    for (const double zenith : {0.0, 45.0}) {
      const Vec3 sun = sun_at(azimuth, zenith);
      const double f = facing(terrain, sun);
      if (f < 0.1) continue;
      const StandLight light = light_of(forest, stand_sky(sun_source(sun), dark_source()), 100'000);
      // As for level layers: one drawing of 20,000 leaves is off by up to 0.003, rays by 0.0015.
      EXPECT_NEAR(light.plot.ground[0] / light.plot.sent[0], std::exp(-0.5 * kLai / f), 0.005)
          << azimuth << " " << zenith;
      EXPECT_NEAR(light.plot.sent[0], f, 1e-6 * f);
    }
}

// The same over all directions of a sky above the plane, summed on a fine net.
double beer_share(const Terrain& terrain, double leaf_area_index) {
  double through = 0, all = 0;
  constexpr int kZ = 400, kTurns = 360;
  for (int i = 0; i < kZ; ++i)
    for (int k = 0; k < kTurns; ++k) {
      const double f = facing(
          terrain, sun_at(360.0 * (k + 0.5) / kTurns, degrees_from_radians(std::acos((i + 0.5) / kZ))));
      if (f > 0) all += f, through += f * std::exp(-0.5 * leaf_area_index / f);
    }
  return through / all;
}

TEST_P(OnASlope, LayerUnderAUniformSkyFollowsBeer) {
  const Terrain terrain = terrain_of(GetParam());
  const Forest forest = slab(terrain, 1.0, {});
  const StandLight light =
      light_of(forest, stand_sky(dark_source(), sky_source(SkyModel::kUniform, 16)), 200'000);
  // Grazing patches are cut by the plane as whole: 0.005 on top of the drawing's.
  EXPECT_NEAR(light.plot.ground[0] / light.plot.sent[0], beer_share(terrain, 1.0), 0.01);
}

TEST_P(OnASlope, BoxesFollowBeerToo) {
  constexpr double kLai = 2.0;
  const Terrain terrain = terrain_of(GetParam());
  const Forest forest = slab(terrain, kLai, {});
  LargeStandOptions options;
  options.voxel_m = 0.25;
  options.boxes_per_cell = 1;
  const LargeStandPrepared prepared = prepare_large_stand(forest, options, {});
  const Vec3 sun = sun_at(GetParam().aspect_deg, 45.0);  // from below the slope
  const LargeStandLight light =
      large_stand_light(forest, prepared, stand_sky(sun_source(sun), dark_source()), {});
  EXPECT_NEAR(light.ground[0] / light.incident[0], std::exp(-0.5 * kLai / facing(terrain, sun)), 0.02);
  EXPECT_NEAR(light.trees[0] + light.ground[0], light.incident[0], 1e-5 * light.incident[0]);
}

// Bright leaves over bright soil, sun and sky: what leaves and ground absorb and what goes back.
TEST_P(OnASlope, AgreesWithTheReference) {
  const Terrain terrain = terrain_of(GetParam());
  const Forest forest = slab(terrain, 1.5, Leaf{0.3, 0.2, 0.0});
  const Vec3 sun = sun_at(GetParam().aspect_deg + 60.0, 40.0);
  const StandLight light = light_of(forest,
                                    stand_sky(sun_source(sun, 300.0),
                                              [] {
                                                LightSource sky = sky_source(SkyModel::kUniform, 12);
                                                for (double& v : sky.strength.value) v *= 90.0;
                                                return sky;
                                              }()),
                                    100'000, 0.25);
  ReferenceOptions options;
  options.rays_per_face = 8;
  options.sun_rays_per_element = 8;
  const LightMap truth = trace_light(forest, 0.25, sunlight(sun, 300.0, 90.0), options);
  const EnergyBudget& b = truth.bands[0].budget;
  EXPECT_NEAR(light.plot.sent[0], b.incident_w, 0.01 * b.incident_w);
  // Rays of both (0.3 %), and 0.5 % for the sky's patches at the plane's edge.
  EXPECT_NEAR(light.plot.bands[0].leaves[0], b.absorbed_foliage_w, 0.008 * b.incident_w);
  EXPECT_NEAR(light.plot.bands[0].ground[0], b.absorbed_ground_w, 0.008 * b.incident_w);
  EXPECT_NEAR(light.plot.bands[0].reflected[0], b.escaped_w, 0.008 * b.incident_w);
}

INSTANTIATE_TEST_SUITE_P(Slopes, OnASlope,
                         ::testing::Values(Slope{0, 0}, Slope{15, 40}, Slope{30, 180}, Slope{45, 300}),
                         [](const auto& at) {
                           return "slope" + std::to_string(static_cast<int>(at.param.slope_deg)) + "aspect" +
                                  std::to_string(static_cast<int>(at.param.aspect_deg));
                         });

}  // namespace
}  // namespace sunfleck::test
