// Rasterised pictures as wholes: shade, ground and wood against rays, order of depth, determinism, refusals.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <stop_token>

#include "lighting/render/raster_choice.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "tests/lighting/render/bush_scene.h"

namespace sunfleck {
namespace {

using test::bush_view;
using test::camera_above;
using test::grey_at;
using test::mean_grey;
using test::parallelogram;
using test::RenderScene;

Image picture(const RenderScene& scene, const LightMap& map, const Camera& camera, Visibility visibility,
              const RunControl& control = {}, const TileSink& tiles = {}) {
  return render(scene.forest, OpticsTable(scene.forest, scene.optics_request), map,
                {camera, scene.light, scene.look, scene.effort, LeafSun::kTraced, {}, visibility}, control,
                tiles);
}

// Per pixel within 6 standard errors of both and 6 % of the mean (wood and ground interpolate their sky), but
// for one pixel in a hundred: the units of a pixel whose samples all agree by chance show no error.
void expect_agreement(const Image& rays, const Image& raster) {
  const double mean = mean_grey(rays);
  int apart = 0;
  for (std::size_t p = 0; p < rays.depth_m.size(); ++p) {
    const double noise = std::hypot(rays.rgb_standard_error[p], raster.rgb_standard_error[p]);
    apart += std::abs(grey_at(rays, p) - grey_at(raster, p)) > 6 * noise + 0.06 * mean;
  }
  EXPECT_LE(apart, static_cast<int>(rays.depth_m.size()) / 100);
  EXPECT_NEAR(mean_grey(raster), mean, 0.01 * mean);
}

TEST(RasterPicture, BushWithShadeAgreesWithRays) {
  const RenderScene scene = test::traced_bush();
  const LightMap map = test::reference_map(scene);
  const Camera camera = bush_view(64);
  expect_agreement(picture(scene, map, camera, Visibility::kRays),
                   picture(scene, map, camera, Visibility::kRaster));
}

TEST(RasterPicture, LowSunOnASlopeAgreesWithRays) {
  RenderScene scene = test::traced_bush();
  scene.forest.terrain.slope_rad = 0.2;
  scene.forest.terrain.aspect_rad = 1.0;
  scene.light.to_sun = glm::normalize(Vec3(1, -1, 0.4));
  const LightMap map = test::reference_map(scene);
  expect_agreement(picture(scene, map, bush_view(64), Visibility::kRays),
                   picture(scene, map, bush_view(64), Visibility::kRaster));
}

TEST(RasterPicture, RepeatedBushAgreesWithRays) {
  RenderScene scene = test::traced_bush();
  scene.forest.period = Period{{-3, -3}, {6, 6}};
  scene.light.to_sun = glm::normalize(Vec3(1, -1, 0.7));
  const LightMap map = test::reference_map(scene);
  Camera camera = bush_view(64);
  camera.position_m = {0, -8, 14};
  expect_agreement(picture(scene, map, camera, Visibility::kRays),
                   picture(scene, map, camera, Visibility::kRaster));
}

// A sheet's shadow on bare ground under a black sky: open ground outside, nothing inside, no bias at its
// foot.
TEST(RasterPicture, ShadowHasItsAreaAndTouchesItsFoot) {
  RenderScene scene;
  scene.override_leaf({0, 0, 0, 0}, 0.0);
  scene.optics_request.soil_albedo = {1.0};
  scene.light.to_sun = glm::normalize(Vec3(1, 0, 1));
  scene.light.sun_half_angle_rad = 0.0;
  scene.light.bands = {{std::sqrt(2.0) * kPi, 0.0}};  // open ground shines with 1
  // A wall 1 m high and 2 m wide, standing on the ground: its shadow is 1 m long.
  scene.leaves() = {parallelogram({0, 0, 0.5f}, {0, 1, 0}, {0, 0, 0.5f})};
  Camera camera = camera_above(4.0, 64);
  camera.samples_per_pixel = 64;
  const Image image = picture(scene, scene.map(), camera, Visibility::kRaster);
  // Two of sixteen square metres; borders of 6 m in pixels of 1/16 m: error below 96^(1/2) / 16 / 4096.
  EXPECT_NEAR(mean_grey(image), 1.0 - 2.0 / 16.0, 0.002);
  EXPECT_NEAR(grey_at(image, test::pixel_at(image, 31, 32)), 0.0, 0.1);
  EXPECT_NEAR(grey_at(image, test::pixel_at(image, 33, 32)), 1.0, 0.02);
}

TEST(RasterPicture, NearestIsSeen) {
  RenderScene scene;
  scene.override_leaf({1, 1, 0, 0});
  scene.leaves() = {parallelogram({0, 0, 1}, {2, 0, 0}, {0, 2, 0})};
  scene.forest.prototypes.push_back(scene.forest.prototypes[0]);
  scene.forest.prototypes[1].foliage = {parallelogram({0, 0, 2}, {1, 0, 0}, {0, 1, 0})};
  for (const bool swapped : {false, true}) {
    scene.forest.instances = {{{0, 0, 0}, PrototypeId{swapped ? 1u : 0u}, 0, 1, {}},
                              {{0, 0, 0}, PrototypeId{swapped ? 0u : 1u}, 0, 1, {}}};
    const Image image = picture(scene, scene.map(), camera_above(6.0, 30), Visibility::kRaster);
    EXPECT_EQ(image.instance_id[test::pixel_at(image, 15, 15)], swapped ? 0.0f : 1.0f);
    EXPECT_EQ(image.instance_id[test::pixel_at(image, 6, 15)], swapped ? 1.0f : 0.0f);
    EXPECT_EQ(image.instance_id[test::pixel_at(image, 1, 15)], -1.0f);
    EXPECT_NEAR(image.depth_m[test::pixel_at(image, 15, 15)], 18.0f, 1e-4f);
    EXPECT_NEAR(image.depth_m[test::pixel_at(image, 1, 15)], 20.0f, 1e-4f);
  }
}

TEST(RasterPicture, IsTheSameForAnyNumberOfThreads) {
  const RenderScene scene = test::traced_bush();
  const LightMap map = test::reference_map(scene);
  Camera camera = bush_view(20);
  camera.width_px = 150;
  Image one, two;
  with_threads(1, [&] { one = picture(scene, map, camera, Visibility::kRaster); });
  with_threads(2, [&] { two = picture(scene, map, camera, Visibility::kRaster); });
  EXPECT_EQ(one.rgb, two.rgb);
  EXPECT_EQ(one.rgb_standard_error, two.rgb_standard_error);
  EXPECT_EQ(one.depth_m, two.depth_m);
}

// The spread of pictures of other seeds is what the stated errors say, within a quarter of it: 1,536 pixels.
TEST(RasterPicture, StatesItsNoise) {
  const RenderScene scene = test::traced_bush();
  const LightMap map = test::reference_map(scene);
  double spread = 0, stated = 0;
  Camera camera = bush_view(64);
  const Image first = picture(scene, map, camera, Visibility::kRaster);
  camera.seed = 2;
  const Image second = picture(scene, map, camera, Visibility::kRaster);
  for (std::size_t p = 0; p < first.depth_m.size(); ++p) {
    spread += std::pow(grey_at(first, p) - grey_at(second, p), 2);
    stated += std::pow(first.rgb_standard_error[p], 2) + std::pow(second.rgb_standard_error[p], 2);
  }
  EXPECT_NEAR(std::sqrt(spread / stated), 1.0, 0.25);
}

TEST(RasterPicture, NoiseTargetTellsEveryTileInEveryRound) {
  RenderScene scene = test::traced_bush();
  const LightMap map = test::reference_map(scene);
  scene.effort.noise = 0.01;
  Camera camera = bush_view(1);
  camera.width_px = 70;
  int tiles = 0;
  const Image image = picture(scene, map, camera, Visibility::kRaster, {},
                              [&](const Image&, int, int, int, int) { ++tiles; });
  EXPECT_LE(image_noise(image), 0.01);
  EXPECT_GT(image.samples_per_pixel, 4);
  EXPECT_EQ(tiles % 2, 0);
  EXPECT_GT(tiles, 2);
  EXPECT_FALSE(image.stopped);
}

TEST(RasterPicture, OnePixelAndOddSizes) {
  const RenderScene scene = test::traced_bush();
  const LightMap map = test::reference_map(scene);
  for (const auto& [width, height] : {std::pair{1, 1}, {65, 1}, {3, 129}}) {
    Camera camera = bush_view(5);
    camera.width_px = width, camera.height_px = height;
    const Image image = picture(scene, map, camera, Visibility::kRaster);
    EXPECT_EQ(image.rgb.size(), 3u * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (const float v : image.rgb) EXPECT_TRUE(std::isfinite(v) && v >= 0.0f);
  }
}

TEST(RasterPicture, StopsWhenAsked) {
  const RenderScene scene = test::traced_bush();
  const LightMap map = test::reference_map(scene);
  std::stop_source source;
  source.request_stop();
  EXPECT_THROW(picture(scene, map, bush_view(4), Visibility::kRaster, {source.get_token(), {}}), Error);
}

TEST(RasterPicture, RefusesWhatItCannotSee) {
  RenderScene scene = test::traced_bush();
  const LightMap map = test::reference_map(scene);
  Camera fisheye = bush_view(4);
  fisheye.kind = CameraKind::kFisheye;
  EXPECT_THROW(picture(scene, map, fisheye, Visibility::kRaster), Error);
  EXPECT_EQ(picture(scene, map, fisheye, Visibility::kAuto).visibility, Visibility::kRays);
  scene.forest.period = Period{{-3, -3}, {6, 6}};
  const Camera horizon = bush_view(4);
  try {
    picture(scene, map, horizon, Visibility::kRaster);
    FAIL() << "a view without end was drawn";
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), "camera.look_at_m");
    EXPECT_NE(error.remedy().find("rays"), std::string::npos);
  }
  EXPECT_EQ(picture(scene, map, horizon, Visibility::kAuto).visibility, Visibility::kRays);
}

// More samples are for the raster, more figures for rays.
TEST(RasterChoice, FollowsCost) {
  RasterWork work;
  work.prototype_figures = 200'000, work.camera_figures = work.sun_figures = 1'500'000;
  work.pixels = 100'000, work.samples_per_pixel = 16, work.sun_directions = 4;
  EXPECT_LT(raster_cost_s(work), rays_cost_s(work));
  RasterWork few = work;
  few.pixels = 1000;
  EXPECT_GT(raster_cost_s(few), rays_cost_s(few));
  RasterWork crowded = work;
  crowded.camera_figures = crowded.sun_figures = 1'000'000'000;
  EXPECT_GT(raster_cost_s(crowded), rays_cost_s(crowded));
}

TEST(RasterPicture, EmptyForestAndNightAreFine) {
  RenderScene scene;
  scene.forest.instances.clear();
  scene.light.bands = {{100.0, 50.0}};
  Camera camera = bush_view(4);
  const Image day = picture(scene, scene.map(), camera, Visibility::kRaster);
  const Image by_rays = picture(scene, scene.map(), camera, Visibility::kRays);
  EXPECT_NEAR(mean_grey(day), mean_grey(by_rays), 0.02 * mean_grey(by_rays));
  RenderScene night = test::traced_bush();
  night.light.to_sun = glm::normalize(Vec3(1, 0, -1));
  const Image dark = picture(night, night.map(), camera, Visibility::kRaster);
  for (const float v : dark.rgb) EXPECT_TRUE(std::isfinite(v));
}

}  // namespace
}  // namespace sunfleck
