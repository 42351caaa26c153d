// Cameras against hand-made projections of single leaves, and every camera that must be refused.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "sim/base/error.h"
#include "tests/lighting/render/render_scene.h"

namespace sunfleck {
namespace {

using test::camera_above;
using test::parallelogram;
using test::Patch;
using test::patch_of;
using test::pixel_at;
using test::RenderScene;

// A level leaf of 2 m x 2 m at 5 m height, centre (1, 2); 64 pixels show 8 m, so a pixel is 0.125 m and the
// leaf is exactly 16 x 16 pixels: columns 32 + (0 .. 2) / 0.125 = 32 .. 47, rows 32 - (1 .. 3) / 0.125 = 8 ..
// 23. The camera is at 20 m: 15 m to the leaf, 20 m to the ground.
TEST(Orthographic, ASquareLeafFillsItsPixels) {
  RenderScene scene;
  scene.leaves() = {parallelogram({1, 2, 5}, {1, 0, 0}, {0, 1, 0})};
  scene.front = {1, 2, 4};
  scene.back = {8, 16, 32};
  const Image image = scene.render(camera_above(8, 64));
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const bool leaf = x >= 32 && x < 48 && y >= 8 && y < 24;
      const std::size_t p = pixel_at(image, x, y);
      ASSERT_EQ(image.instance_id[p], leaf ? 0.0f : -1.0f) << x << " " << y;
      ASSERT_NEAR(image.depth_m[p], leaf ? 15.0 : 20.0, 1e-4);
      ASSERT_EQ(image.irradiance_w_m2[p], leaf ? 63.0f : 0.0f);
      ASSERT_NEAR(image.normal[3 * p + 2], 1.0f, 1e-6f);
    }
}

// Seen from (0, -10, 0) along +y with 60 degrees over 200 pixels, a leaf at (2, 0, 3) lies at
// x = 150 + 100 (2 / 10) / tan 30 = 184.64, y = 100 - 100 (3 / 10) / tan 30 = 48.04. It is 0.4 m wide: 13.9
// pixels of 0.0577 m; the centroid of its pixels is within half a pixel.
TEST(Pinhole, ALeafProjectsWhereItShould) {
  RenderScene scene;
  scene.leaves() = {parallelogram({2, 0, 3}, {0.2f, 0, 0}, {0, 0, 0.2f})};
  scene.forest.terrain.elevation_m = -5;
  Camera camera;
  camera.position_m = {0, -10, 0};
  camera.look_at_m = {0, 0, 0};
  camera.vertical_fov_deg = 60;
  camera.width_px = 300;
  camera.height_px = 200;
  camera.samples_per_pixel = 1;
  const Image image = scene.render(camera);
  const Patch patch = patch_of(image, 0);
  const double px_per_m = 100.0 / (10.0 * std::tan(radians_from_degrees(30)));
  EXPECT_NEAR(patch.x_px, 150 + 2 * px_per_m, 0.5);
  EXPECT_NEAR(patch.y_px, 100 - 3 * px_per_m, 0.5);
  EXPECT_NEAR(patch.pixels, std::pow(0.4 * px_per_m, 2), 4 * 0.4 * px_per_m);  // within a rim of one pixel
  // Distance along the ray, not along the axis: sqrt(2^2 + 10^2 + 3^2) at the leaf's centre.
  const std::size_t centre = pixel_at(image, static_cast<int>(patch.x_px), static_cast<int>(patch.y_px));
  EXPECT_NEAR(image.depth_m[centre], std::sqrt(113.0), 0.05);
}

// Looking up with north as top, a leaf at zenith angle a towards azimuth phi lies a / 90 degrees of the
// radius from the centre, north up and east to the left, as in a hemispherical photograph.
TEST(Fisheye, RadiusGrowsWithZenithAngle) {
  constexpr int side_px = 400;
  for (const double zenith_deg : {5.0, 30.0, 45.0, 60.0, 85.0})
    for (const double azimuth_deg : {0.0, 90.0, 225.0}) {
      RenderScene scene;
      const Vec3 towards =
          direction_from_azimuth_zenith(radians_from_degrees(azimuth_deg), radians_from_degrees(zenith_deg));
      const Basis basis = basis_around(towards);
      scene.leaves() = {
          parallelogram(Vec3f(10.0 * towards), Vec3f(0.3 * basis.tangent), Vec3f(0.3 * basis.bitangent))};
      scene.forest.terrain.elevation_m = -1;
      Camera camera;
      camera.kind = CameraKind::kFisheye;
      camera.position_m = {0, 0, 0};
      camera.look_at_m = {0, 0, 1};
      camera.up = {0, 1, 0};
      camera.width_px = camera.height_px = side_px;
      camera.samples_per_pixel = 1;
      const Patch patch = patch_of(scene.render(camera), 0);
      const double radius_px = zenith_deg / 90.0 * side_px / 2;
      const double azimuth_rad = radians_from_degrees(azimuth_deg);
      ASSERT_GT(patch.pixels, 20) << zenith_deg << " " << azimuth_deg;
      EXPECT_NEAR(patch.x_px, side_px / 2 - radius_px * std::sin(azimuth_rad), 0.5);
      EXPECT_NEAR(patch.y_px, side_px / 2 - radius_px * std::cos(azimuth_rad), 0.5);
    }
}

TEST(Fisheye, OutsideTheCircleThereIsNothing) {
  RenderScene scene;
  scene.light.bands = {{0.0, 100.0}};
  Camera camera;
  camera.kind = CameraKind::kFisheye;
  camera.look_at_m = camera.position_m + Vec3(0, 0, 1);
  camera.width_px = 64;
  camera.height_px = 32;
  const Image image = scene.render(camera);
  EXPECT_EQ(image.rgb[3 * pixel_at(image, 0, 16)], 0.0f);
  EXPECT_NEAR(image.rgb[3 * pixel_at(image, 32, 16)], 100.0 / kPi, 1e-4);
  EXPECT_TRUE(std::isinf(image.depth_m[pixel_at(image, 0, 16)]));
}

// Up along the view gives no direction in the picture: north serves instead.
TEST(Camera, UpAlongTheViewMeansNorth) {
  RenderScene scene;
  scene.leaves() = {parallelogram({1, 2, 5}, {1, 0, 0}, {0, 1, 0})};
  Camera camera = camera_above(8, 64);
  const Image expected = scene.render(camera);
  camera.up = {0, 0, 1};
  EXPECT_EQ(scene.render(camera).instance_id, expected.instance_id);
}

struct BadCamera {
  const char* field;
  std::function<void(Camera&)> spoil;
};

TEST(Camera, EachBadFieldIsNamedWithARemedy) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const BadCamera table[] = {
      {"position_m", [=](Camera& c) { c.position_m.y = nan; }},
      {"look_at_m", [=](Camera& c) { c.look_at_m.x = inf; }},
      {"look_at_m", [](Camera& c) { c.look_at_m = c.position_m; }},
      {"look_at_m",
       [](Camera& c) {
         c.look_at_m = {1e308, 1e308, 1e308};
       }},
      {"up", [=](Camera& c) { c.up.z = nan; }},
      {"up",
       [](Camera& c) {
         c.up = {0, 0, 0};
       }},
      {"vertical_fov_deg", [](Camera& c) { c.vertical_fov_deg = 0; }},
      {"vertical_fov_deg", [](Camera& c) { c.vertical_fov_deg = -10; }},
      {"vertical_fov_deg", [](Camera& c) { c.vertical_fov_deg = 171; }},
      {"vertical_fov_deg", [=](Camera& c) { c.vertical_fov_deg = nan; }},
      {"ortho_height_m", [](Camera& c) { c.kind = CameraKind::kOrthographic, c.ortho_height_m = 0; }},
      {"ortho_height_m", [=](Camera& c) { c.kind = CameraKind::kOrthographic, c.ortho_height_m = nan; }},
      {"ortho_height_m", [=](Camera& c) { c.kind = CameraKind::kOrthographic, c.ortho_height_m = inf; }},
      {"width_px", [](Camera& c) { c.width_px = 0; }},
      {"width_px", [](Camera& c) { c.width_px = 16385; }},
      {"height_px", [](Camera& c) { c.height_px = -1; }},
      {"height_px", [](Camera& c) { c.height_px = 100000; }},
      {"samples_per_pixel", [](Camera& c) { c.samples_per_pixel = 0; }},
      {"samples_per_pixel", [](Camera& c) { c.samples_per_pixel = 4097; }},
  };
  validate(Camera{});
  for (const BadCamera& bad : table) {
    Camera camera;
    bad.spoil(camera);
    try {
      validate(camera);
      ADD_FAILURE() << bad.field << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput);
      EXPECT_EQ(error.where(), std::string("camera.") + bad.field) << error.what();
      EXPECT_FALSE(error.problem().empty());
      EXPECT_FALSE(error.remedy().empty());
    }
  }
}

}  // namespace
}  // namespace sunfleck
