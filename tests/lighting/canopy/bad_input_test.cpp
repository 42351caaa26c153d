// Every mistake has its own message that says where and what would be right.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "lighting/canopy/large_stand.h"
#include "sim/base/error.h"
#include "tests/lighting/canopy/stand_scenes.h"

namespace sunfleck::test {
namespace {

void expect_refused(const std::string& where, const std::string& problem, const std::function<void()>& act) {
  try {
    act();
    ADD_FAILURE() << "not refused: " << where << " " << problem;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput);
    EXPECT_NE(error.where().find(where), std::string::npos) << error.what();
    EXPECT_NE(error.problem().find(problem), std::string::npos) << error.what();
    EXPECT_FALSE(error.remedy().empty());
  }
}

StandSky good_sky() { return stand_sky(sun_source({0, 0, 1}), sky_source(SkyModel::kUniform, 3)); }

TEST(BadSky, IsRefused) {
  expect_refused("sky", "has no directions", [] { checked(StandSky{}); });
  expect_refused("sky.sun.to_source[0]", "no direction", [] {
    StandSky sky = good_sky();
    sky.sun.to_source[0] = Vec3(0.0);
    checked(sky);
  });
  expect_refused("sky.sky.to_source[2]", "no direction", [] {
    StandSky sky = good_sky();
    sky.sky.to_source[2].x = std::numeric_limits<double>::quiet_NaN();
    checked(sky);
  });
  expect_refused("sky.sky.strength[1]", "negative", [] {
    StandSky sky = good_sky();
    sky.sky.strength.value[1] = -1.0;
    checked(sky);
  });
  expect_refused("sky.sun.strength[0]", "names direction 7 of 1", [] {
    StandSky sky = good_sky();
    sky.sun.strength.column[0] = 7;
    checked(sky);
  });
  expect_refused("sky.sun.strength", "has 1 rows for 2 intervals", [] {
    StandSky sky = good_sky();
    sky.intervals.push_back("another");
    checked(sky);
  });
  expect_refused("sky.sky.half_angle_rad", "entries", [] {
    StandSky sky = good_sky();
    sky.sky.half_angle_rad.pop_back();
    checked(sky);
  });
  expect_refused("weights", "has 5 weights for 2 intervals and 3 directions",
                 [] { weight_rows(std::vector<double>(5, 1.0), 2, 3, "weights"); });
}

TEST(BadSensor, IsRefused) {
  const Forest forest = small_stand(true);
  const StandScene scene(forest, {});
  const auto check = [&](LightSensor sensor) {
    return [&scene, sensor] { checked(std::vector<LightSensor>{{"fine", {1.7, 1.7}, 0.5}, sensor}, scene); };
  };
  expect_refused("sensors[1] (s)", "outside the map", check({"s", {2.5, 0.5}, 1.0}));
  expect_refused("sensors[1] (s)", "not above the ground", check({"s", {0.5, 0.5}, -1.0}));
  expect_refused("sensors[1] (s)", "not above the ground", check({"s", {0.5, 0.5}, 0.0}));
  expect_refused("sensors[1] (s)", "no number",
                 check({"s", {std::numeric_limits<double>::infinity(), 0.5}, 1.0}));
  expect_refused("sensors[1] (s)", "inside the stem or a branch of tree 100", check({"s", {0.41, 0.5}, 0.3}));
  expect_refused("sensors[1] (s).normal", "no direction", check({"s", {0.2, 1.5}, 1.0, {0, 0, 0}}));
}

TEST(BadScene, IsRefused) {
  const Forest forest = small_stand(false);
  const auto with = [&](const std::function<void(StandSceneOptions&)>& change) {
    return [&forest, change] {
      StandSceneOptions options;
      change(options);
      const StandScene scene(forest, options);
    };
  };
  expect_refused("stand.ground_cell_m", "cannot be", with([](auto& o) { o.ground_cell_m = 0; }));
  expect_refused("stand.layer_m", "cannot be", with([](auto& o) { o.layer_m = -1; }));
  expect_refused("stand.map", "one corner", with([](auto& o) { o.map_lo_m = Vec2(0); }));
  expect_refused("stand.map", "wrong way", with([](auto& o) {
                   o.map_lo_m = Vec2(1);
                   o.map_hi_m = Vec2(0);
                 }));
  expect_refused("forest", "no trees", [] { const StandScene scene(Forest{}, {}); });
  expect_refused("forest", "no trees", [] { box_canopy(Forest{}, 1.0, {}); });
  expect_refused("large_stand.voxel_m", "out of range", [&] {
    LargeStandOptions options;
    options.voxel_m = 0;
    prepare_large_stand(forest, options, {});
  });
}

TEST(BadRequest, IsRefused) {
  const Forest forest = small_stand(true);
  const StandScene scene(forest, {});
  StandLightRequest request;
  request.sky = good_sky();
  const auto with = [&](const std::function<void(StandLightRequest&)>& change) {
    return [&, change] {
      StandLightRequest r = request;
      change(r);
      prepare_stand_light(scene, optics_of(forest, 0.1), r, {});
    };
  };
  expect_refused("rays_per_cell", "out of range", with([](auto& r) { r.rays_per_cell = 0; }));
  expect_refused("tree_relative_error", "out of range", with([](auto& r) { r.tree_relative_error = -1; }));
  expect_refused("potential_rays", "out of range", with([](auto& r) { r.potential_rays = 0; }));
  expect_refused("sensor_rays", "out of range", with([](auto& r) { r.sensor_sky_rays = 0; }));
  expect_refused("canopy.last_zenith_deg", "out of range", with([](auto& r) {
                   r.canopy_views = true;
                   r.canopy.last_zenith_deg = 5;
                 }));
  // Weights on a direction that the basis was not made for.
  request.sky.sun.strength = WeightRows{};
  request.sky.sun.strength.end_row();
  const DirectionalBasis basis = prepare_stand_light(scene, optics_of(forest, 0.1), request, {});
  WeightRows sun;
  sun.add(0, 1.0);
  sun.end_row();
  expect_refused("sun", "which the basis left out",
                 [&] { stand_light(scene, basis, sun, request.sky.sky.strength, {"day"}, {}); });
}

TEST(StandLight, StopsWhenAsked) {
  const Forest forest = small_stand(true);
  const StandScene scene(forest, {});
  StandLightRequest request;
  request.sky = good_sky();
  std::stop_source stop;
  stop.request_stop();
  RunControl control;
  control.stop = stop.get_token();
  EXPECT_THROW(stand_light(scene, optics_of(forest, 0.1), request, control), Error);
}

}  // namespace
}  // namespace sunfleck::test
