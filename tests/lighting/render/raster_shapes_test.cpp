// What rasterising sees, shape by shape: areas known on paper, and the very pixels that rays give through the
// same places.
#include <gtest/gtest.h>

#include <cmath>

#include "lighting/render/path_samples.h"
#include "lighting/render/raster_samples.h"
#include "sim/base/random.h"
#include "tests/lighting/render/render_scene.h"

namespace sunfleck {
namespace {

using test::camera_above;
using test::parallelogram;
using test::RenderScene;

// Leaves that shine with radiance 1, black wood, no light else: a picture's mean is the share that leaves
// cover.
RenderScene shining() {
  RenderScene scene;
  scene.override_leaf({1, 1, 0, 0}, 0.0);
  scene.optics_request.soil_albedo = {0.0};
  scene.front.sky_w_m2 = scene.back.sky_w_m2 = static_cast<float>(kPi);
  scene.visibility = Visibility::kRaster;
  return scene;
}

double mean(const Image& image) {
  double sum = 0;
  for (const float v : image.rgb) sum += v;
  return sum / static_cast<double>(image.rgb.size());
}

FoliageElement leaf_of(ElementShape shape, const Vec3f& centre, const Vec3f& u, const Vec3f& v) {
  FoliageElement e = parallelogram(centre, u, v);
  e.shape = shape;
  if (shape == ElementShape::kDisc) e.area_m2 *= static_cast<float>(kPi) / 4;
  if (shape == ElementShape::kTriangle) e.area_m2 /= 8;
  return e;
}

Image seen(RenderScene scene, Camera camera, Visibility visibility, int samples) {
  scene.visibility = visibility;
  camera.samples_per_pixel = samples;
  return scene.render(camera);
}

// Same samples, same answers: only samples that a border passes within rounding may differ.
void expect_same(const RenderScene& scene, const Camera& camera, double most_different = 0.002) {
  const Image rays = seen(scene, camera, Visibility::kRays, 16);
  const Image raster = seen(scene, camera, Visibility::kRaster, 16);
  EXPECT_EQ(rays.visibility, Visibility::kRays);
  ASSERT_EQ(raster.visibility, Visibility::kRaster);
  EXPECT_EQ(rays.samples_per_pixel, raster.samples_per_pixel);
  std::size_t different = 0, other_instance = 0;
  for (std::size_t p = 0; p < rays.depth_m.size(); ++p) {
    different += std::abs(rays.rgb[3 * p] - raster.rgb[3 * p]) > 1e-4f * (1.0f + rays.rgb[3 * p]);
    if (rays.instance_id[p] != raster.instance_id[p]) {
      ++other_instance;
    } else if (std::isfinite(rays.depth_m[p])) {
      EXPECT_NEAR(rays.depth_m[p], raster.depth_m[p], 1e-4f * rays.depth_m[p]) << p;
      EXPECT_EQ(rays.irradiance_w_m2[p], raster.irradiance_w_m2[p]) << p;
    } else {
      EXPECT_EQ(rays.depth_m[p], raster.depth_m[p]);
    }
  }
  const double pixels = static_cast<double>(rays.depth_m.size());
  EXPECT_LE(static_cast<double>(different), 1 + 16 * most_different * pixels);
  EXPECT_LE(static_cast<double>(other_instance), 1 + most_different * pixels);
  EXPECT_GT(mean(raster), 0.0);
}

void scatter(ElementShape shape, RenderScene& scene, int count) {
  RandomStream random(5, 0, RandomPurpose::kTestScene);
  const auto number = [&](double lo, double hi) { return static_cast<float>(random.uniform(lo, hi)); };
  for (int i = 0; i < count; ++i) {
    const Vec3 u = 0.25 * glm::normalize(Vec3(number(-1, 1), number(-1, 1), number(-1, 1)));
    const Vec3 v = 0.25 * glm::normalize(glm::cross(u, Vec3(number(-1, 1), number(-1, 1), number(-1, 1))));
    scene.leaves().push_back(
        leaf_of(shape, {number(-2, 2), number(-2, 2), number(1, 5)}, Vec3f(u), Vec3f(v)));
  }
}

Camera pinhole(const Vec3& from, const Vec3& to) {
  Camera camera;
  camera.position_m = from;
  camera.look_at_m = to;
  camera.width_px = 70, camera.height_px = 45;
  return camera;
}

TEST(RasterSamples, LieWhereRaysGo) {
  for (std::uint64_t pixel : {0ull, 7ull, 99999ull})
    for (std::uint32_t unit = 0; unit < 5; ++unit)
      for (std::uint32_t sample = 0; sample < 16; ++sample) {
        const auto ray = PathSamples(3, pixel, unit, sample).next();
        const auto place = SamplePlaces(3, pixel, unit).at(sample);
        EXPECT_EQ(ray[0], place[0]);
        EXPECT_EQ(ray[1], place[1]);
      }
}

// 64 samples in each of 32 x 32 pixels: borders of at most 130 pixels' length, each with a standard error
// below half a pixel's area by eight: 130^(1/2) / 16 / 1024 < 0.0008 of the picture.
TEST(RasterShapes, CoverTheirArea) {
  const double picture_m2 = 16.0;
  const auto covered = [&](const FoliageElement& leaf) {
    RenderScene scene = shining();
    scene.leaves() = {leaf};
    return mean(seen(scene, camera_above(4.0, 32), Visibility::kRaster, 64));
  };
  EXPECT_NEAR(covered(leaf_of(ElementShape::kParallelogram, {0.1f, 0.2f, 3}, {1, 0, 0}, {0.3f, 0.5f, 1})),
              4 * 0.5 / picture_m2, 0.003);
  EXPECT_NEAR(covered(leaf_of(ElementShape::kDisc, {0.1f, 0.2f, 3}, {1.2f, 0, 0}, {0, 1.2f, 0})),
              kPi * 1.44 / picture_m2, 0.003);
  EXPECT_NEAR(covered(leaf_of(ElementShape::kTriangle, {0.1f, 0.2f, 3}, {1.5f, 0, 0}, {0, 2.0f, 0.7f})),
              0.5 * 1.5 * 2.0 / picture_m2, 0.003);
}

// White wood on black ground under an even sky, thick and thin (a strip). Thick: every pixel inside the
// trapezoid shows some of it, none outside. Both: as bright as by rays, whose 900 (thin) and more samples of
// wood bring sky or nothing each: 12 % are 3.5 standard errors.
TEST(RasterShapes, WoodCoversItsSilhouette) {
  for (const float thin : {1.0f, 0.1f}) {
    RenderScene scene;
    scene.override_leaf({0, 0, 0, 0}, 1.0);
    scene.optics_request.soil_albedo = {0.0};
    scene.light.bands = {{0.0, 1.0}};
    scene.wood() = {{{-1.5f, 0, 3}, {1.2f, 0.4f, 3}, 0.6f * thin, 0.2f * thin, 0}};
    const Image raster = seen(scene, camera_above(4.0, 32), Visibility::kRaster, 64);
    const Image rays = seen(scene, camera_above(4.0, 32), Visibility::kRays, 64);
    EXPECT_NEAR(mean(raster), mean(rays), 0.12 * mean(rays));
    double shown = 0;
    for (std::size_t p = 0; p < raster.depth_m.size(); ++p) shown += raster.rgb[3 * p] > 0.0f;
    const double area = 0.8 * thin * std::hypot(2.7, 0.4) / 16.0;
    EXPECT_GE(shown / 1024.0, area);
    if (thin < 1.0f) continue;
    EXPECT_LE(shown / 1024.0, area + 120.0 / 1024.0);  // pixels of its border
  }
}

// Opacity of a shoot along its chord: 1 - exp(-extinction * chord). Looked at along its axis: the same chord
// everywhere, and the whole disc of its end.
TEST(RasterShapes, ShootLetsThroughItsMeanOpacity) {
  RenderScene scene = shining();
  FoliageElement shoot;
  shoot.shape = ElementShape::kShoot;
  shoot.centre_m = {0, 0, 3};
  shoot.half_u_m = {0, 0, 0.5f};
  shoot.half_v_m = {1.5f, 0, 0};
  shoot.area_m2 = 12.0f;
  scene.leaves() = {shoot};
  const double disc_m2 = kPi * 1.5 * 1.5, depth = 0.5 * 12.0 / disc_m2;
  const double expected = disc_m2 / 16.0 * (1.0 - std::exp(-depth));
  // 65,536 lots of chance one half: standard error 0.001.
  EXPECT_NEAR(mean(seen(scene, camera_above(4.0, 32), Visibility::kRaster, 64)), expected, 0.005);
  EXPECT_NEAR(mean(seen(scene, pinhole({0, -6, 3}, {0, 0, 3}), Visibility::kRaster, 64)),
              mean(seen(scene, pinhole({0, -6, 3}, {0, 0, 3}), Visibility::kRays, 64)), 0.005);
  // From within its needles.
  EXPECT_NEAR(mean(seen(scene, pinhole({0, 0.2, 3}, {0, 2, 3}), Visibility::kRaster, 64)),
              mean(seen(scene, pinhole({0, 0.2, 3}, {0, 2, 3}), Visibility::kRays, 64)), 0.01);
}

TEST(RasterShapes, SameAsRaysForEveryShape) {
  for (const ElementShape shape :
       {ElementShape::kParallelogram, ElementShape::kDisc, ElementShape::kTriangle}) {
    RenderScene scene = shining();
    scatter(shape, scene, 200);
    expect_same(scene, pinhole({0, -9, 4}, {0, 0, 3}));
    expect_same(scene, camera_above(5.0, 40));
  }
}

TEST(RasterShapes, SameAsRaysForOutlines) {
  RenderScene scene = shining();
  scatter(ElementShape::kParallelogram, scene, 200);
  scene.look.outline = LeafOutline::kLobed;
  expect_same(scene, pinhole({0, -6, 4}, {0, 0, 3}));
}

// Leaves behind, beside and across the plane of the camera.
TEST(RasterShapes, SameAsRaysFromAmongLeaves) {
  RenderScene scene = shining();
  scatter(ElementShape::kParallelogram, scene, 600);
  expect_same(scene, pinhole({0, 0, 3}, {1, 0.3, 3.1}));
  expect_same(scene, pinhole({0, 0, 3}, {0.2, 0.3, 8}));
}

TEST(RasterShapes, SameAsRaysForTurnedScaledTrees) {
  RenderScene scene = shining();
  scatter(ElementShape::kDisc, scene, 60);
  scene.forest.instances.clear();
  for (int i = 0; i < 9; ++i)
    scene.forest.instances.push_back({{4.0 * (i % 3), 4.0 * (i / 3), 0},
                                      PrototypeId{0},
                                      0.7f * static_cast<float>(i),
                                      0.6f + 0.1f * static_cast<float>(i),
                                      {}});
  expect_same(scene, pinhole({-6, -9, 6}, {4, 4, 2}));
}

TEST(RasterShapes, SameAsRaysInARepeatedForest) {
  RenderScene scene = shining();
  scatter(ElementShape::kParallelogram, scene, 60);
  scene.forest.period = Period{{-3, -3}, {6, 6}};
  expect_same(scene, pinhole({1, -2, 14}, {3, 2, 0}));
  Camera above = camera_above(15.0, 40);
  above.position_m = {2, 1, 20}, above.look_at_m = {2, 1, 0};
  expect_same(scene, above);
}

TEST(RasterShapes, MetreLeavesFarFromTheOriginStaySharp) {
  RenderScene scene = shining();
  scatter(ElementShape::kParallelogram, scene, 100);
  const Vec3 far(4e5, -3e5, 0);
  scene.forest.instances[0].position_m = far;
  expect_same(scene, pinhole(far + Vec3(0, -9, 4), far + Vec3(0, 0, 3)));
}

}  // namespace
}  // namespace sunfleck
