// What stand light always keeps: energy, linearity, determinism; and traced light beside it.
#include <gtest/gtest.h>

#include <cmath>

#include "lighting/canopy/exp_lanes.h"
#include "lighting/canopy/large_stand.h"
#include "lighting/canopy/large_stand_check.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/forest/forest_spec.h"
#include "tests/lighting/canopy/stand_scenes.h"

namespace sunfleck::test {
namespace {

const Vec3 kSun = direction_from_azimuth_zenith(2.0, 0.8);

StandLightRequest request(double rays_per_cell) {
  StandLightRequest r;
  r.sky = stand_sky(sun_source(kSun, 300.0), sky_source(SkyModel::kStandardOvercast, 5));
  for (double& v : r.sky.sky.strength.value) v *= 90.0;
  r.sensors = {LightSensor{"a", {0.9, 1.6}, 0.3, {0, 0, 1}},
               LightSensor{"tilted", {1.5, 0.3}, 0.5, {1, 0, 1}}};
  r.rays_per_cell = rays_per_cell;
  r.tree_relative_error = 0;
  r.potential_rays = 20'000;
  return r;
}

StandSceneOptions map() {
  StandSceneOptions o;
  o.ground_cell_m = 0.5;
  o.layer_m = 0.2;
  o.map_lo_m = Vec2(0, 0);
  o.map_hi_m = Vec2(2, 2);
  return o;
}

StandLight light_of(const Forest& forest, const StandLightRequest& r) {
  const StandScene scene(forest, map());
  return stand_light(scene, optics_of(forest, 0.15), r, {});
}

void expect_closed(const StandLight& light) {
  const PlotTables& p = light.plot;
  // Sums in single precision of up to a hundred directions.
  const double rounding = 1e-5 * p.sent[0];
  EXPECT_NEAR(p.leaves[0] + p.wood[0] + p.ground[0] + p.beyond[0] + p.missed[0], p.sent[0], rounding);
  const PlotBand& b = p.bands[0];
  EXPECT_NEAR(b.leaves[0] + b.wood[0] + b.ground[0] + b.reflected[0] + b.beyond[0] + p.missed[0], p.sent[0],
              rounding);
  double trees = 0.0, layers = 0.0, absorbed = 0.0;
  for (std::size_t t = 0; t < light.tree_ids.size(); ++t) {
    trees += light.trees.intercepted.at(0, t);
    absorbed += light.trees.absorbed[0].at(0, t);
  }
  for (std::size_t k = 0; k < light.layers.leaf_area_m2.size(); ++k)
    layers += light.layers.intercepted.at(0, k);
  EXPECT_NEAR(trees, p.leaves[0] + p.wood[0], rounding);
  EXPECT_NEAR(layers, p.leaves[0] + p.wood[0], rounding);
  EXPECT_NEAR(absorbed, b.leaves[0], rounding);
}

TEST(StandLight, ClosesItsEnergyBudget) {
  for (const bool periodic : {true, false}) {
    const StandLight light = light_of(small_stand(periodic), request(2000));
    expect_closed(light);
    EXPECT_EQ(light.plot.missed[0], 0.0);
    if (periodic) {
      EXPECT_NEAR(light.plot.sent[0], light.plot.on_map[0], 1e-5 * light.plot.sent[0]);
      EXPECT_EQ(light.plot.beyond[0], 0.0);
    }
  }
}

TEST(StandLight, SameBytesForAnyNumberOfThreads) {
  const Forest forest = small_stand(true);
  StandLight one, two;
  with_threads(1, [&] { one = light_of(forest, request(200)); });
  with_threads(2, [&] { two = light_of(forest, request(200)); });
  EXPECT_EQ(one.ground.total.value, two.ground.total.value);
  EXPECT_EQ(one.trees.absorbed[0].value, two.trees.absorbed[0].value);
  EXPECT_EQ(one.trees.potential.value, two.trees.potential.value);
  EXPECT_EQ(one.sensors.total.value, two.sensors.total.value);
}

// One basis, many intervals: each hour by itself adds up to the day, twice the strength gives twice the
// light.
TEST(StandLight, IsLinearInTheWeights) {
  const Forest forest = small_stand(true);
  const StandScene scene(forest, map());
  const StandLightRequest r = request(500);
  const DirectionalBasis basis = prepare_stand_light(scene, optics_of(forest, 0.15), r, {});
  WeightRows sun, sky;
  constexpr int kHours = 200;
  for (int h = 0; h < kHours; ++h) {
    sun.add(0, h % 2 ? 600.0 / kHours : 0.0);
    for (std::size_t d = 0; d < basis.sky.sky.size(); ++d) sky.add(d, r.sky.sky.strength.value[d] / kHours);
    sun.end_row();
    sky.end_row();
  }
  const std::vector<std::string> labels(kHours, "hour");
  const StandLight hours = stand_light(scene, basis, sun, sky, labels, {});
  const StandLight day = light_of(forest, r);
  for (std::size_t t = 0; t < 3; ++t) {
    double sum = 0.0;
    for (std::size_t h = 0; h < kHours; ++h) sum += hours.trees.absorbed[0].at(h, t);
    EXPECT_NEAR(sum, day.trees.absorbed[0].at(0, t), 1e-4 * sum);
  }
  EXPECT_NEAR(hours.sensors.gap_light_index[0], day.sensors.gap_light_index[0], 1e-5);
  EXPECT_EQ(hours.sensors.direct.at(0, 0), 0.0f);  // an hour without sun
}

// Four patches of a quarter hemisphere each: radiance 1 brings pi to a level plane where to_source.z is 1/2.
TEST(LightSources, FromPatchesAndBins) {
  std::vector<Vec3> to;
  for (int k = 0; k < 4; ++k) to.push_back(direction_from_azimuth_zenith(0.5 * kPi * k, kPi / 3.0));
  const std::vector<double> solid_angle(4, 0.5 * kPi), radiance(4, 1.0);
  const LightSource sky = sky_patches(to, solid_angle, weight_rows(radiance, 1, 4, "w"));
  EXPECT_NEAR(open_energy(sky, {0, 0, 1})[0], kPi, 1e-12);
  EXPECT_NEAR(2.0 * kPi * (1.0 - std::cos(sky.half_angle(2))), 0.5 * kPi, 1e-12);
  const LightSource sun = sun_bins(to, {}, weight_rows(radiance, 2, 2, "w"));
  EXPECT_EQ(sun.half_angle(0), 0.0);
  EXPECT_NEAR(open_energy(sun, to[0])[0], 1.0 + glm::dot(to[0], to[1]), 1e-12);
}

// Alone in the open nothing competes, and a tree takes what it could.
TEST(StandLight, ATreeAloneHasNoCompetition) {
  Forest forest = small_stand(false);
  forest.instances.resize(1);
  StandLightRequest r = request(20'000);
  const StandLight light = light_of(forest, r);
  // Two independent counts of about 10,000 rays each: standard error 1 %.
  EXPECT_NEAR(light.trees.light_competition.at(0, 0), 1.0, 0.04);
  EXPECT_NEAR(light.trees.intercepted.at(0, 0), light.plot.leaves[0] + light.plot.wood[0],
              1e-5 * light.plot.sent[0]);
}

TEST(StandLight, TakesAsManyRaysAsTheErrorAskedForNeeds) {
  const Forest forest = small_stand(true);
  StandLightRequest r = request(50);
  const StandLight coarse = light_of(forest, r);
  r.tree_relative_error = 0.01;
  const StandLight fine = light_of(forest, r);
  for (std::size_t t = 0; t < 3; ++t) {
    EXPECT_GT(coarse.trees.intercepted.error_at(0, t), 0.02f * coarse.trees.intercepted.at(0, t));
    // The pilot's own estimate is rough.
    EXPECT_LT(fine.trees.intercepted.error_at(0, t), 0.015f * fine.trees.intercepted.at(0, t));
  }
}

TEST(StandLight, AgreesWithTheReference) {
  const Forest forest = small_stand(true);
  const StandLight light = light_of(forest, request(20'000));
  Illumination sun = sunlight(kSun, 300.0, 90.0);
  sun.sky = SkyModel::kStandardOvercast;
  ReferenceOptions options;
  options.rays_per_face = 128;
  options.sun_rays_per_element = 128;
  const LightMap truth = trace_light(forest, 0.15, sun, options);
  for (std::size_t t = 0; t < 3; ++t) {
    const TreeLight& tree = truth.bands[0].trees[t];
    // Both errors, and 1 % for a sky of 5 rings and light that is even over a leaf of the reference.
    const double error = std::hypot(4.0 * light.trees.absorbed[0].error_at(0, t),
                                    4.0 * tree.absorbed_standard_error_w, 0.01 * tree.absorbed_w);
    EXPECT_NEAR(light.trees.absorbed[0].at(0, t), tree.absorbed_w, error) << t;
    EXPECT_LT(error, 0.05 * tree.absorbed_w);
  }
  const EnergyBudget& b = truth.bands[0].budget;
  EXPECT_NEAR(light.plot.bands[0].ground[0], b.absorbed_ground_w, 0.02 * b.incident_w);
  EXPECT_NEAR(light.plot.bands[0].reflected[0], b.escaped_w, 0.01 * b.incident_w);
}

TEST(StandLight, ASensorInTheOpenSeesAllLight) {
  Forest forest = small_stand(false);
  for (Instance& tree : forest.instances) tree.position_m.x += 1000.0;
  StandLightRequest r = request(1);
  StandSceneOptions o = map();
  o.map_hi_m = Vec2(1010, 2);
  o.ground_cell_m = 50;
  const StandScene scene(forest, o);
  const StandLight light = stand_light(scene, optics_of(forest, 0.0), r, {});
  EXPECT_NEAR(light.sensors.gap_light_index[0], 1.0, 1e-3);  // trees stand a kilometre off
  EXPECT_NEAR(light.sensors.gap_light_index[1], 1.0, 1e-3);
  // Tilted towards east: its open light is that of its own plane.
  EXPECT_NEAR(light.sensors.open_direct.at(0, 1),
              300.0 * std::max(0.0, glm::dot(kSun, glm::normalize(Vec3(1, 0, 1)))), 1e-3);
}

TEST(StandLight, NightGivesZeros) {
  StandLightRequest r = request(10);
  r.sky = {sun_source({0, 1, -0.2}), dark_source(), {"polar night"}};
  const StandLight light = light_of(small_stand(true), r);
  EXPECT_EQ(light.plot.sent[0], 0.0);
  EXPECT_EQ(light.sensors.pacl_total.at(0, 0), 0.0f);
  EXPECT_EQ(light.trees.absorbed[0].at(0, 0), 0.0f);
  EXPECT_EQ(light.plot.bands[0].fapar[0], 0.0);
}

// Trees around the plot that nobody measured: they shade and throw light back as before, but light is
// followed only where it can matter for the others.
TEST(StandLight, SurroundingsAskForFewerRaysAndChangeNothing) {
  Forest forest = small_stand(false);
  for (int x = -5; x <= 6; ++x)
    for (int y = -5; y <= 6; ++y) {
      if (x >= 0 && x <= 1 && y >= 0 && y <= 1) continue;
      Instance tree = forest.instances[0];
      tree.position_m = {0.5 + x, 0.5 + y, 0};
      tree.tree = {1000 + static_cast<std::uint32_t>(12 * x + y + 65)};
      forest.instances.push_back(tree);
    }
  StandLightRequest r = request(20'000);
  r.sky.sky = sky_source(SkyModel::kStandardOvercast, 3);
  for (double& v : r.sky.sky.strength.value) v *= 90.0;
  r.potential_rays = 1000;
  const StandLight all = light_of(forest, r);
  for (std::size_t t = 3; t < forest.instances.size(); ++t)
    forest.instances[t].tree = virtual_tree(forest.instances[t].tree.value);
  const StandLight asked = light_of(forest, r);
  expect_closed(asked);
  EXPECT_LT(asked.plot.sent[0], 0.6 * all.plot.sent[0]);
  for (std::size_t t = 0; t < 3; ++t) {
    const auto near = [&](const IntervalTable& a, const IntervalTable& b, double relative) {
      const double error = 4.0 * std::hypot(a.error_at(0, t), b.error_at(0, t)) + relative * b.at(0, t);
      EXPECT_NEAR(a.at(0, t), b.at(0, t), error) << t;
    };
    near(asked.trees.intercepted, all.trees.intercepted, 0.0);
    // What scatters in from beyond half the forest's height: under 1 % at albedo 0.15.
    near(asked.trees.absorbed[0], all.trees.absorbed[0], 0.01);
    near(asked.trees.potential, all.trees.potential, 0.0);
  }
  EXPECT_GT(all.trees.potential.at(0, 3), 0.0f);
  EXPECT_EQ(asked.trees.potential.at(0, 3), 0.0f);
  EXPECT_NEAR(asked.ground.total.at(0, 5), all.ground.total.at(0, 5),
              4.0 * std::hypot(asked.ground.total.error_at(0, 5), all.ground.total.error_at(0, 5)));
}

// A screen in the east: on the left of a picture that looks up.
TEST(Photograph, EastIsOnTheLeft) {
  const Forest forest = forest_of({quad({3, 0, 2}, {0, 50, 0}, {0, 0, 2})});
  StandSceneOptions o;
  o.map_lo_m = Vec2(-5, -5);
  o.map_hi_m = Vec2(5, 5);
  const StandScene scene(forest, o);
  const auto picture = hemispherical_photograph(scene, {"", {0, 0}, 0.5, {0, 0, 1}}, {.pixels = 64}, {});
  const auto at = [&](int row, int column) {
    return picture.sky[static_cast<std::size_t>(row) * 64 + static_cast<std::size_t>(column)];
  };
  EXPECT_EQ(at(32, 4), 0.0f);   // east, near the horizon: the screen
  EXPECT_EQ(at(32, 59), 1.0f);  // west
  EXPECT_EQ(at(4, 32), 1.0f);   // north, along the screen
  EXPECT_EQ(at(0, 0), 0.0f);    // outside the circle
}

TEST(LargeStandLight, ClosesEnergyAndAgreesWithRays) {
  Forest forest = small_stand(true);
  LargeStandOptions options;
  options.voxel_m = 0.2;
  options.boxes_per_cell = 2;
  options.crown_rays = 20'000;
  const LargeStandPrepared prepared = prepare_large_stand(forest, options, {});
  StandLightRequest r = request(20'000);  // many directions: one alone hits boxes by chance
  r.sky = stand_sky(dark_source(), sky_source(SkyModel::kUniform, 6));
  const LargeStandLight world = large_stand_light(forest, prepared, r.sky, {});
  EXPECT_NEAR(world.trees[0] + world.ground[0], world.incident[0], 1e-5 * world.incident[0]);
  const StandLight rays = light_of(forest, r);
  // Boxes of a fifth of a metre in crowns of a metre with leaves of 12 cm, which of them hide behind a
  // neighbour is blurred: 10 % of a tree, 3 % of all.
  double boxes = 0.0, traced = 0.0;
  for (std::size_t t = 0; t < 3; ++t) {
    boxes += world.tree_intercepted.at(0, t);
    traced += rays.trees.intercepted.at(0, t);
    EXPECT_NEAR(world.tree_intercepted.at(0, t), rays.trees.intercepted.at(0, t),
                0.1 * rays.trees.intercepted.at(0, t));
    EXPECT_NEAR(world.tree_potential.at(0, t), rays.trees.potential.at(0, t),
                0.05 * rays.trees.potential.at(0, t));
  }
  EXPECT_NEAR(boxes, traced, 0.05 * traced);
  // The same comparison by its own rays: 4,000 from each of 60 directions tell a tree to 0.5 %.
  LargeStandLight told = world;
  const LargeStandCheck check = check_large_stand(forest, prepared, r.sky, world, {1000, 1000, 1000}, {});
  ASSERT_EQ(check.trees, 3u);
  ASSERT_EQ(check.cells, prepared.map.count());
  double off2 = 0.0, boxes2 = 0.0;
  for (std::size_t t = 0; t < 3; ++t) {
    off2 += std::pow(rays.trees.intercepted.at(0, t) - world.tree_intercepted.at(0, t), 2);
    boxes2 += std::pow(world.tree_intercepted.at(0, t), 2);
  }
  EXPECT_NEAR(check.tree_bias, 1.0 - traced / boxes, 0.01);
  EXPECT_NEAR(check.tree_error, std::sqrt(off2 / boxes2), 0.015);
  double ground = 0.0;
  for (std::size_t c = 0; c < check.cells; ++c)
    ground += world.ground_total.at(0, c) / static_cast<double>(check.cells);
  // Both know the mean light on the ground: what boxes say less the rays' share of the plot.
  EXPECT_NEAR(check.ground_bias, ground - rays.plot.ground[0] / rays.plot.sent[0], 0.01);
  set_errors(check, r.sky, told);
  EXPECT_NEAR(told.tree_intercepted.error_at(0, 1), check.tree_error * told.tree_intercepted.at(0, 1), 1e-6);
  EXPECT_NEAR(told.ground_total.error_at(0, 1), check.ground_error, 1e-6);  // open light is 1
  EXPECT_THROW(check_large_stand(forest, prepared, r.sky, world, {1, 1, 0}, {}), Error);
}

// In the open, trees take what they would take alone where they do not shade each other. Crowns four boxes
// wide take a few percent more or less as they lie in the boxes.
TEST(LargeStandLight, TreesFarApartInTheOpen) {
  Forest forest = small_stand(false);
  forest.prototypes[0].foliage = random_leaves(Crown::kSphere, {0, 0, 1.2}, Vec3(0.5), 4000, 0.033, 6);
  for (std::size_t i = 0; i < 3; ++i) forest.instances[i].position_m = {10.0 * static_cast<double>(i), 0, 0};
  LargeStandOptions options;
  options.voxel_m = 0.1;
  const LargeStandPrepared prepared = prepare_large_stand(forest, options, {});
  const StandSky sky = stand_sky(dark_source(), sky_source(SkyModel::kUniform, 6));
  const LargeStandLight light = large_stand_light(forest, prepared, sky, {});
  for (std::size_t t = 0; t < 3; ++t) EXPECT_NEAR(light.light_competition.at(0, t), 1.0, 0.06) << t;
  // The lowest sun: shadows of kilometres, no memory of kilometres.
  const Vec3 low = direction_from_azimuth_zenith(1.0, 0.5 * kPi - 1e-4);
  const LargeStandLight evening =
      large_stand_light(forest, prepared, stand_sky(sun_source(low), dark_source()), {});
  for (std::size_t t = 0; t < 3; ++t) {
    EXPECT_TRUE(std::isfinite(evening.tree_intercepted.at(0, t)));
    EXPECT_GE(evening.tree_intercepted.at(0, t), 0.0f);
  }
}

TEST(LargeStandLight, SameBytesForAnyNumberAtOnce) {
  const Forest forest = small_stand(true);
  LargeStandOptions options;
  options.voxel_m = 0.2;
  LargeStandLight one, four;
  options.directions_at_once = 1;
  with_threads(1, [&] {
    one = large_stand_light(forest, prepare_large_stand(forest, options, {}), request(1).sky, {});
  });
  options.directions_at_once = 4;
  with_threads(2, [&] {
    four = large_stand_light(forest, prepare_large_stand(forest, options, {}), request(1).sky, {});
  });
  EXPECT_EQ(one.ground_total.value, four.ground_total.value);
  EXPECT_EQ(one.tree_intercepted.value, four.tree_intercepted.value);
}

TEST(ExpLanes, FollowsTheExponential) {
  for (double x = 0.0; x < 80.0; x += 0.0137)
    EXPECT_NEAR(exp_of_minus(static_cast<float>(x)) / std::exp(-static_cast<double>(static_cast<float>(x))),
                1.0,
                2e-6);  // rounding of x / ln 2 grows with x: 80 * 2^-24 / 2
  EXPECT_EQ(exp_of_minus(0.0f), 1.0f);
  EXPECT_GT(exp_of_minus(1e30f), 0.0f);
}

}  // namespace
}  // namespace sunfleck::test
