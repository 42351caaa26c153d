// Radiances that are known on paper: leaves from both sides, open and shaded ground, the sun's disc, and the
// furnace, where nothing may be seen.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/base/error.h"
#include "sim/base/random.h"
#include "tests/lighting/render/render_scene.h"

namespace sunfleck {
namespace {

using test::camera_above;
using test::parallelogram;
using test::pixel_at;
using test::RenderScene;

double red_at(const Image& image, int x, int y) { return image.rgb[3 * pixel_at(image, x, y)]; }

// Seen from the front L = (r_f E_f + t_b E_b) / pi = (0.5 * 70 + 0.125 * 16) / pi, from the back
// (r_b E_b + t_f E_f) / pi = (0.25 * 16 + 0.375 * 70) / pi. A band that is not PAR is grey.
TEST(Shading, ALeafShowsReflectedAndTransmittedLight) {
  RenderScene scene;
  scene.leaves() = {parallelogram({0, 0, 5}, {2, 0, 0}, {0, 2, 0})};
  scene.override_leaf({0.5, 0.25, 0.375, 0.125});
  scene.front = {10, 20, 40};
  scene.back = {16, 0, 0};
  Camera camera = camera_above(2, 4);
  EXPECT_NEAR(red_at(scene.render(camera), 2, 2), (0.5 * 70 + 0.125 * 16) / kPi, 1e-5);
  camera.position_m = {0, 0, 1};
  camera.look_at_m = {0, 0, 10};
  const Image from_below = scene.render(camera);
  EXPECT_NEAR(red_at(from_below, 2, 2), (0.25 * 16 + 0.375 * 70) / kPi, 1e-5);
  EXPECT_EQ(from_below.rgb[0], from_below.rgb[1]);
  EXPECT_EQ(from_below.rgb[0], from_below.rgb[2]);
  EXPECT_NEAR(from_below.normal[2], -1.0f, 1e-6f);  // turned towards the viewer
}

// A shoot shows the mean of its faces: ((0.5 + 0.375) 70 + (0.25 + 0.125) 16) / 2 pi.
TEST(Shading, AShootShowsTheMeanOfItsFaces) {
  RenderScene scene;
  FoliageElement shoot;
  shoot.shape = ElementShape::kShoot;
  shoot.centre_m = {0, 0, 5};
  shoot.half_u_m = {2, 0, 0};
  shoot.half_v_m = {0, 1, 0};
  shoot.area_m2 = 1e4f;  // so dense that no ray gets through
  scene.leaves() = {shoot};
  scene.override_leaf({0.5, 0.25, 0.375, 0.125});
  scene.front = {10, 20, 40};
  scene.back = {16, 0, 0};
  const Image image = scene.render(camera_above(0.5, 4));
  EXPECT_NEAR(red_at(image, 2, 2), (0.875 * 70 + 0.375 * 16) / (2 * kPi), 1e-5);
}

// Leaves keep green, bark and soil lean to red; the order of the channels is all that is promised.
TEST(Shading, ParIsColoured) {
  RenderScene scene;
  scene.use_band("PAR");
  scene.leaves() = {parallelogram({0, 0, 5}, {1, 0, 0}, {0, 1, 0})};
  scene.override_leaf({0.1, 0.1, 0.05, 0.05});
  scene.front = {0, 100, 0};
  scene.light.bands = {{0.0, 100.0}};
  const Image image = scene.render(camera_above(8, 8));
  const float* leaf = &image.rgb[3 * pixel_at(image, 4, 4)];
  const float* soil = &image.rgb[3 * pixel_at(image, 0, 0)];
  EXPECT_GT(leaf[1], 1.5f * leaf[0]);
  EXPECT_GT(leaf[0], leaf[2]);
  EXPECT_GT(soil[0], soil[1]);
  EXPECT_GT(soil[1], soil[2]);
}

// Open level ground under a sun 60 degrees from the zenith: L = 0.2 (300 cos 60 + 100) / pi. Every gather ray
// meets the uniform sky, so there is no noise.
TEST(Shading, OpenGroundIsExact) {
  RenderScene scene;
  scene.light.to_sun = direction_from_azimuth_zenith(0.3, radians_from_degrees(60));
  scene.light.bands = {{300.0, 100.0}};
  const Image image = scene.render(camera_above(8, 8));
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) ASSERT_NEAR(red_at(image, x, y), 0.2 * 250 / kPi, 1e-4);
}

// A leaf at 4 m height shades the ground 4 m to the north of it when the sun stands in the south at 45
// degrees. In the shade only sky light is left: at most 0.2 * 100 / pi; in the open at least the beam.
TEST(Shading, ShadowsFallAwayFromTheSun) {
  RenderScene scene;
  scene.leaves() = {parallelogram({0, -3, 4}, {0.5f, 0, 0}, {0, 0.5f, 0})};
  scene.light.to_sun = direction_from_azimuth_zenith(kPi, radians_from_degrees(45));
  scene.light.bands = {{300.0, 100.0}};
  const Image image = scene.render(camera_above(8, 80));  // 0.1 m per pixel, the shadow's centre at y = +1
  const double sky_only = 0.2 * 100 / kPi, beam = 0.2 * 300 * std::sqrt(0.5) / kPi;
  for (const auto& [x_m, y_m] : {std::pair{0.0, 1.0}, {0.3, 1.3}, {-0.3, 0.7}})
    EXPECT_LE(red_at(image, static_cast<int>(40 + 10 * x_m), static_cast<int>(40 - 10 * y_m)),
              sky_only + 1e-4);
  for (const auto& [x_m, y_m] : {std::pair{0.0, 2.0}, {1.0, 1.0}, {0.0, 0.0}})
    EXPECT_GE(red_at(image, static_cast<int>(40 + 10 * x_m), static_cast<int>(40 - 10 * y_m)), beam - 1e-4);
}

// The disc of half angle a has radiance beam / (pi sin^2 a): it puts exactly `beam` on a plane that faces it.
TEST(Shading, TheSunHasADisc) {
  RenderScene scene;
  scene.light.to_sun = glm::normalize(Vec3(0.2, 1, 1));
  scene.light.sun_half_angle_rad = radians_from_degrees(0.265);
  scene.light.bands = {{500.0, 100.0}};
  Camera camera;
  camera.look_at_m = camera.position_m + scene.light.to_sun;
  camera.vertical_fov_deg = 2;
  camera.width_px = camera.height_px = 101;
  camera.samples_per_pixel = 1;
  const Image image = scene.render(camera);
  const double disc = 500.0 / (kPi * std::pow(std::sin(scene.light.sun_half_angle_rad), 2));
  EXPECT_NEAR(red_at(image, 50, 50), disc + 100 / kPi, 1e-6 * disc);
  EXPECT_NEAR(red_at(image, 2, 2), 100 / kPi, 1e-4);
  double flux = 0;  // radiance times solid angle of the pixels: 2 degrees over 101 pixels, nearly flat
  const double pixel_sr = std::pow(2 * std::tan(radians_from_degrees(1)) / 101, 2);
  for (std::size_t p = 0; p < image.depth_m.size(); ++p) flux += (image.rgb[3 * p] - 100 / kPi) * pixel_sr;
  EXPECT_NEAR(flux, 500.0, 0.03 * 500);  // rim pixels: +- 1 % by area, and jitter
}

// Everything white under a uniform sky of radiance L: leaves carry E = pi L on both faces, and leaves, wood,
// ground and sky all look the same, from every camera, without noise.
TEST(Furnace, NothingCanBeSeen) {
  RenderScene scene;
  scene.use_band("PAR");
  scene.optics_request.soil_albedo = {1.0};
  scene.override_leaf({0.6, 0.6, 0.4, 0.4}, 1.0);
  RandomStream random(5, 0, RandomPurpose::kTestScene);
  for (int i = 0; i < 200; ++i) {
    const auto number = [&](double lo, double hi) { return static_cast<float>(random.uniform(lo, hi)); };
    const Basis basis = basis_around(glm::normalize(Vec3(number(-1, 1), number(-1, 1), number(-1, 1))));
    scene.leaves().push_back(parallelogram({number(-2, 2), number(-2, 2), number(1, 5)},
                                           Vec3f(0.2 * basis.tangent), Vec3f(0.2 * basis.bitangent)));
  }
  scene.wood() = {{{0, 0, 0}, {0, 0, 4}, 0.2f, 0.1f, 0}};
  constexpr double radiance = 7.0;
  scene.front = scene.back = {0, static_cast<float>(0.75 * kPi * radiance), 0};
  scene.front.scattered_w_m2 = scene.back.scattered_w_m2 = static_cast<float>(0.25 * kPi * radiance);
  scene.light.bands = {{0.0, kPi * radiance}};
  Camera camera;
  camera.position_m = {0, -9, 3};
  camera.look_at_m = {0, 0, 3};
  camera.vertical_fov_deg = 60;
  camera.width_px = camera.height_px = 96;
  const Image image = scene.render(camera);
  bool sky = false, plant = false, ground = false;
  for (std::size_t p = 0; p < image.depth_m.size(); ++p) {
    sky |= std::isinf(image.depth_m[p]);
    plant |= image.instance_id[p] == 0.0f;
    ground |= image.instance_id[p] < 0 && std::isfinite(image.depth_m[p]);
    for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(image.rgb[3 * p + c], radiance, 1e-5 * radiance);
    ASSERT_LT(image.rgb_standard_error[p], 1e-5 * radiance);
  }
  EXPECT_TRUE(sky && plant && ground);
}

// A black leaf before a white sky: a pixel of which k of n samples meet the leaf has mean (1 - k/n) L and
// standard error L sqrt(k/n (1 - k/n) / (n - 1)), so the one follows from the other.
TEST(StandardError, FollowsFromTheSamples) {
  RenderScene scene;
  scene.leaves() = {parallelogram({0, 0, 5}, {1, 0, 0}, {0, 1, 0})};
  scene.light.bands = {{0.0, kPi * 10}};
  Camera camera = camera_above(3.3, 16);
  camera.position_m = {0, 0, 1};
  camera.look_at_m = {0, 0, 5};
  camera.samples_per_pixel = 7;  // fewer than 8: every sample is a unit of its own
  const Image image = scene.render(camera);
  int mixed = 0;
  for (std::size_t p = 0; p < image.depth_m.size(); ++p) {
    const double seen = image.rgb[3 * p] / 10.0;  // share of the sky
    mixed += seen > 0.01 && seen < 0.99;
    EXPECT_NEAR(image.rgb_standard_error[p], 10.0 * std::sqrt(seen * (1 - std::min(1.0, seen)) / 6), 5e-3);
  }
  EXPECT_GT(mixed, 20);
}

TEST(Render, AMapOfAnotherForestOrBandIsRefused) {
  RenderScene scene;
  scene.leaves() = {parallelogram({0, 0, 5}, {1, 0, 0}, {0, 1, 0})};
  const OpticsTable optics(scene.forest, scene.optics_request);
  const auto refused = [&](const LightMap& map, const char* says) {
    try {
      render(scene.forest, optics, map, {camera_above(8, 8), scene.light}, {});
      ADD_FAILURE() << "accepted: " << says;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput);
      EXPECT_EQ(error.where(), "map");
      EXPECT_NE(error.problem().find(says), std::string::npos) << error.what();
    }
  };
  LightMap map = scene.map();
  map.bands[0].elements.clear();
  refused(map, "0 elements, 1 are needed");
  map = scene.map();
  map.bands[0].band = "PAR";
  refused(map, "band PAR where the optics have NIR");
  map.bands.clear();
  refused(map, "0 bands");
}

}  // namespace
}  // namespace sunfleck
