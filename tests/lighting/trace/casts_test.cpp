// Rays of each cast meet the trees of that cast: as instances, in a table, written out, and in a forest that
// repeats; and a path stays in its cast.
#include <gtest/gtest.h>

#include "lighting/trace/ray_scene.h"

namespace sunfleck {
namespace {

// A level square leaf of 2 m at this height.
Prototype level_leaf(float height_m) {
  Prototype plant;
  plant.materials = {"leaf"};
  FoliageElement leaf;
  leaf.centre_m = {0, 0, height_m};
  leaf.half_u_m = {1, 0, 0};
  leaf.half_v_m = {0, 1, 0};
  leaf.area_m2 = 4;
  plant.foliage = {leaf};
  return plant;
}

Forest three_plants(std::size_t count) {
  Forest forest;
  forest.materials = {{"leaf", {}}};
  forest.prototypes = {level_leaf(5), level_leaf(7)};
  forest.instances.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    forest.instances[i].position_m = {static_cast<double>(10 * i), 0, 0};
  return forest;
}

const PrototypeId kLow{0}, kHigh{1};

void expect_casts(const Forest& forest, RayScene::Options options) {
  const std::size_t count = forest.instances.size();
  options.casts = {std::vector(count, kLow), std::vector(count, kHigh), std::vector(count, kLow)};
  options.casts[2][count - 1] = kHigh;
  const RayScene scene(forest, options);
  for (std::uint8_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < count; ++i) {
      const double expected_m = options.casts[c][i] == kHigh ? 7 : 5;
      const Vec3 above = forest.instances[i].position_m + Vec3(0.1, 0.1, 20);
      const RayHit hit = scene.closest_hit(above, {0, 0, -1}, 0, {.cast = c});
      ASSERT_EQ(hit.kind, HitKind::kFoliage);
      EXPECT_EQ(hit.cast, c);
      EXPECT_EQ(hit.instance, i);
      EXPECT_NEAR(hit.position_m.z, expected_m, 1e-5);
      // On from the leaf, past itself: the ground below, the sky above; from between the heights as they are.
      EXPECT_EQ(scene.closest_hit(hit.on_original_m, {0, 0, -1}, 0, start_from(hit, false)).kind,
                HitKind::kGround);
      EXPECT_FALSE(scene.occluded(hit.on_original_m, {0, 0, 1}, 0, start_from(hit, true)));
      const Vec3 between = forest.instances[i].position_m + Vec3(0.1, 0.1, 6);
      EXPECT_EQ(scene.occluded(between, {0, 0, 1}, 0, {.cast = c}), expected_m == 7);
    }
}

TEST(Casts, RaysMeetTheirOwn) {
  expect_casts(three_plants(3), {});
  expect_casts(three_plants(3), {.table_from = 1});
  expect_casts(three_plants(1), {});  // written out
  Forest repeats = three_plants(3);
  repeats.period = Period{{-5, -5}, {30, 10}};
  expect_casts(repeats, {});
}

// One cast of the instances' own prototypes is the scene without casts.
TEST(Casts, OneCastIsTheForest) {
  Forest forest = three_plants(4);
  forest.instances[1].prototype = kHigh;
  const RayScene plain(forest, {}), cast(forest, {.casts = {{kLow, kHigh, kLow, kLow}}});
  for (double x = -2; x < 35; x += 0.37) {
    const RayHit a = plain.closest_hit({x, 0.3, 20}, {0, 0, -1}),
                 b = cast.closest_hit({x, 0.3, 20}, {0, 0, -1});
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.position_m, b.position_m);
    EXPECT_EQ(a.instance, b.instance);
  }
}

}  // namespace
}  // namespace sunfleck
