// Trees that a picture does not need: left out, a picture from a light map keeps every byte of every layer,
// and a path-traced one stays within the stated share of light. Scene: 20 x 20 trees 10 m apart, each of its
// own leaves and stem, with stored light that differs from leaf to leaf, so that a wrong number shows.
#include "lighting/render/seen_trees.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "lighting/render/camera_rays.h"
#include "lighting/render/loaded_light.h"
#include "sim/base/error.h"
#include "sim/base/random.h"
#include "tests/lighting/render/render_scene.h"

namespace sunfleck {
namespace {

constexpr int kColumns = 20, kLeaves = 60;
constexpr double kSpacingM = 10;

Prototype small_tree(std::uint64_t number) {
  RandomStream random(5, number, RandomPurpose::kTestScene);
  const auto draw = [&](double lo, double hi) { return static_cast<float>(random.uniform(lo, hi)); };
  Prototype tree;
  tree.name = "tree " + std::to_string(number);
  tree.materials = {"leaf"};
  const float height_m = draw(5, 9);
  tree.wood.push_back({{0, 0, 0}, {0, 0, height_m}, 0.2f, 0.05f, 0});
  for (int i = 0; i < kLeaves; ++i) {
    const Vec3f centre(draw(-2, 2), draw(-2, 2), draw(0.3 * height_m, height_m));
    tree.foliage.push_back(test::parallelogram(centre, {draw(.1, .4), draw(-.4, .4), draw(-.2, .2)},
                                               {draw(-.2, .2), draw(.1, .4), draw(-.3, .3)}));
  }
  return tree;
}

struct Orchard {
  test::RenderScene scene;
  LightMap map;

  explicit Orchard(double slope_deg = 0) {
    scene.use_band("PAR");
    scene.override_leaf({0.12, 0.10, 0.06, 0.05}, 0.3);
    scene.leaf_sun = LeafSun::kTraced;
    scene.look = PictureLook{};
    scene.light.to_sun = direction_from_azimuth_zenith(radians_from_degrees(200), radians_from_degrees(50));
    scene.light.bands = {BandLight{600, 120}};
    Forest& forest = scene.forest;
    forest.terrain.slope_rad = radians_from_degrees(slope_deg);
    forest.prototypes.clear(), forest.instances.clear();
    for (std::uint32_t i = 0; i < kColumns * kColumns; ++i) {
      forest.prototypes.push_back(small_tree(i));
      Instance tree;
      const double x = kSpacingM * (i % kColumns), y = kSpacingM * (i / kColumns);
      tree.position_m = {x, y, forest.terrain.height_at(x, y)};
      tree.yaw_rad = static_cast<float>(i);
      tree.scale = 1.0f + 0.001f * static_cast<float>(i % 7);
      tree.prototype = PrototypeId{i};
      tree.tree = TreeId{i + 1};
      forest.instances.push_back(tree);
    }
    map = scene.map();
    for (std::size_t e = 0; e < map.bands[0].elements.size(); ++e) {
      const auto light = static_cast<float>(e % 997);
      map.bands[0].elements[e].front = {0, 0.1f * light, 0.02f * light};
      map.bands[0].elements[e].back = {0, 0.05f * light, 0.01f * light};
    }
  }

  Visibility visibility = Visibility::kRays;
  PictureDetail detail{};

  RenderRequest request(const Camera& camera) const {
    return {camera, scene.light, scene.look, scene.effort, scene.leaf_sun, detail, visibility};
  }
  OpticsTable optics(const Forest& forest) const { return OpticsTable(forest, scene.optics_request); }
  TreeSelection selection(const Camera& camera, RenderMode mode, double far_light = 0) const {
    return trees_for_picture(outline_of(scene.forest), scene.forest.materials, request(camera), mode,
                             far_light);
  }
  // What load_prototypes would give.
  Forest loaded(const TreeSelection& selection) const {
    Forest part = scene.forest;
    for (std::size_t p = 0; p < part.prototypes.size(); ++p)
      if (!selection.prototypes[p]) part.prototypes[p].foliage.clear(), part.prototypes[p].wood.clear();
    return part;
  }
};

Camera camera_at(const Vec3& position_m, const Vec3& look_at_m, double fov_deg = 40) {
  Camera camera;
  camera.position_m = position_m;
  camera.look_at_m = look_at_m;
  camera.vertical_fov_deg = fov_deg;
  camera.width_px = 96, camera.height_px = 64;
  camera.samples_per_pixel = 4;
  return camera;
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void expect_same_picture(const Orchard& orchard, const Camera& camera, std::size_t most_trees) {
  const TreeSelection chosen = orchard.selection(camera, RenderMode::kLightMap);
  EXPECT_LE(chosen.trees_needed, most_trees);
  EXPECT_EQ(chosen.light_bound, 0.0);
  const Forest part = orchard.loaded(chosen);
  const Image all = render(orchard.scene.forest, orchard.optics(orchard.scene.forest), orchard.map,
                           orchard.request(camera), {});
  const LightMap light = light_of_loaded(orchard.map, outline_of(orchard.scene.forest), chosen.prototypes);
  EXPECT_EQ(light.bands[0].elements.size(), ForestIndex(part).element_count());
  const Image some = render(part, orchard.optics(part), light, orchard.request(camera), {});
  EXPECT_TRUE(same_bytes(all.rgb, some.rgb));
  EXPECT_TRUE(same_bytes(all.depth_m, some.depth_m));
  EXPECT_TRUE(same_bytes(all.normal, some.normal));
  EXPECT_TRUE(same_bytes(all.instance_id, some.instance_id));
  EXPECT_TRUE(same_bytes(all.irradiance_w_m2, some.irradiance_w_m2));
  EXPECT_TRUE(same_bytes(all.rgb_standard_error, some.rgb_standard_error));
}

TEST(SeenTrees, PictureAmongTreesKeepsItsBytes) {
  const Orchard orchard;
  expect_same_picture(orchard, camera_at({155, 155, 2}, {175, 190, 4}), 260);
}

TEST(SeenTrees, PictureFromAboveKeepsItsBytes) {
  const Orchard orchard;
  expect_same_picture(orchard, camera_at({30, 30, 40}, {35, 36, 0}, 30), 200);
}

TEST(SeenTrees, PictureByParallelRaysKeepsItsBytes) {
  const Orchard orchard;
  Camera camera = camera_at({20, 180, 60}, {22, 181, 0});
  camera.kind = CameraKind::kOrthographic;
  camera.ortho_height_m = 20;
  expect_same_picture(orchard, camera, 200);
}

TEST(SeenTrees, RasterisedPicturesKeepTheirBytes) {
  Orchard orchard;
  orchard.visibility = Visibility::kRaster;
  expect_same_picture(orchard, camera_at({155, 155, 2}, {175, 190, 4}), 260);
  expect_same_picture(orchard, camera_at({30, 30, 40}, {35, 36, 0}, 30), 200);
}

// Enlarged leaves reach farther than the boxes that the file states.
TEST(SeenTrees, LevelsOfDetailKeepAllTrees) {
  Orchard orchard;
  orchard.detail.mode = DetailMode::kAuto;
  const Camera camera = camera_at({155, 155, 2}, {175, 190, 4});
  EXPECT_EQ(orchard.selection(camera, RenderMode::kLightMap).trees_needed, 400u);
}

TEST(SeenTrees, FisheyePictureKeepsItsBytes) {
  const Orchard orchard;
  Camera camera = camera_at({-5, 95, 3}, {-30, 95, 4});  // looks out of the stand
  camera.kind = CameraKind::kFisheye;
  expect_same_picture(orchard, camera, 260);
}

TEST(SeenTrees, LowSunAndSlopeKeepTheBytes) {
  Orchard orchard(10);
  orchard.scene.light.to_sun =
      direction_from_azimuth_zenith(radians_from_degrees(30), radians_from_degrees(70));
  orchard.scene.light.sun_half_angle_rad = 0.0047;
  const double ground_m = orchard.scene.forest.terrain.height_at(35, 155);
  expect_same_picture(orchard, camera_at({35, 155, ground_m + 2}, {10, 185, ground_m - 2}), 380);
}

// Behind a slope that the sun does not reach every tree may shade: none may be left out, none is missed.
TEST(SeenTrees, SunBehindTheSlopeKeepsTheBytes) {
  Orchard orchard(20);
  orchard.scene.light.to_sun =
      direction_from_azimuth_zenith(radians_from_degrees(180), radians_from_degrees(80));
  const double ground_m = orchard.scene.forest.terrain.height_at(35, 155);
  expect_same_picture(orchard, camera_at({35, 155, ground_m + 2}, {10, 185, ground_m - 8}), 400);
}

TEST(SeenTrees, AnEmptyViewKeepsItsBytes) {
  const Orchard orchard;
  expect_same_picture(orchard, camera_at({-80, 100, 20}, {-200, 100, 0}), 60);
}

// Paths are the same but where they met trees that are gone: what differs is their share of light, no noise.
// Bound: far_light of what an open place gets, times the brightest reflection (soil .2, leaves less) / pi.
TEST(SeenTrees, PathTracedPictureStaysWithinItsBound) {
  const Orchard orchard;
  Camera camera = camera_at({175, 175, 2}, {190, 195, 4});
  camera.samples_per_pixel = 16;
  const double far_light = 0.1;
  const TreeSelection chosen = orchard.selection(camera, RenderMode::kPathTraced, far_light);
  EXPECT_LT(chosen.trees_needed, 300u);
  EXPECT_EQ(chosen.light_bound, far_light);
  const Forest part = orchard.loaded(chosen);
  const Image all = render_path_traced(orchard.scene.forest, orchard.optics(orchard.scene.forest),
                                       orchard.request(camera), {});
  const Image some = render_path_traced(part, orchard.optics(part), orchard.request(camera), {});
  const double open_w_m2 = 600 * orchard.scene.light.to_sun.z + 120;
  double apart = 0;
  for (std::size_t c = 0; c < all.rgb.size(); ++c)
    apart += std::fabs(static_cast<double>(all.rgb[c]) - some.rgb[c]) / static_cast<double>(all.rgb.size());
  EXPECT_LE(apart, far_light * open_w_m2 * 0.2 / kPi);
  EXPECT_TRUE(same_bytes(all.instance_id, some.instance_id));  // what is seen is all there
  EXPECT_TRUE(same_bytes(all.depth_m, some.depth_m));
}

TEST(SeenTrees, PathsAndRepeatingForestsKeepAllTrees) {
  Orchard orchard;
  const Camera camera = camera_at({155, 155, 2}, {175, 190, 4});
  EXPECT_EQ(orchard.selection(camera, RenderMode::kPathTraced).trees_needed, 400u);
  orchard.scene.forest.period = Period{{-5, -5}, {200, 200}};
  EXPECT_EQ(orchard.selection(camera, RenderMode::kLightMap).prototypes_needed, 400u);
}

TEST(SeenTrees, ViewVolumeHoldsWhatCamerasSee) {
  for (const CameraKind kind : {CameraKind::kPinhole, CameraKind::kOrthographic, CameraKind::kFisheye}) {
    Camera camera = camera_at({1, 2, 3}, {9, -4, 1}, 70);
    camera.kind = kind;
    const ViewVolume view(camera);
    const CameraRays rays(camera);
    RandomStream random(3, 0, RandomPurpose::kTestScene);
    for (int i = 0; i < 1000; ++i) {
      const auto ray = rays.through(random.uniform(0, camera.width_px), random.uniform(0, camera.height_px));
      if (!ray) continue;
      const Vec3 p = ray->origin_m + random.uniform(0, 100) * ray->direction;
      const Box point{p, p};
      EXPECT_TRUE(view.may_meet(std::span(&point, 1), 1e-9));
    }
    const Vec3 behind = camera.position_m - (camera.look_at_m - camera.position_m);
    const Box point{behind, behind};
    EXPECT_FALSE(view.may_meet(std::span(&point, 1), 1.0));
  }
}

TEST(SeenTrees, BadRequestsAreRefused) {
  const Orchard orchard;
  const Camera camera = camera_at({155, 155, 2}, {175, 190, 4});
  for (const double share : {-0.1, 0.6, std::nan("")})
    EXPECT_THROW(orchard.selection(camera, RenderMode::kPathTraced, share), Error);
  LightMap short_map = orchard.map;
  short_map.bands[0].elements.pop_back();
  const std::vector<char> loaded(orchard.scene.forest.prototypes.size(), 1);
  EXPECT_THROW(light_of_loaded(short_map, outline_of(orchard.scene.forest), loaded), Error);
}

}  // namespace
}  // namespace sunfleck
