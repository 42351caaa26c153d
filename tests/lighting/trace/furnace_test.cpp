// The furnace: nothing absorbs, so light is the same everywhere, whatever stands in the scene. With a sky of
// diffuse irradiance 1 every face, however it is turned, must receive exactly 1.
#include <gtest/gtest.h>

#include "tests/lighting/trace/scenes.h"

namespace sunfleck::test {
namespace {

void expect_all_lit_by_one(const LightMap& map) {
  double worst = 0.0;
  for (const ElementLight& e : map.bands[0].elements)
    for (const FaceLight& f : {e.front, e.back}) worst = std::max(worst, std::abs(f.total() - 1.0));
  EXPECT_LT(worst, 1e-6);
}

ReferenceOptions tight() {
  ReferenceOptions o;
  o.convergence = 1e-8;
  o.max_iterations = 2000;
  return o;
}

TEST(Furnace, RandomCrownOverWhiteGround) {
  const Forest forest =
      forest_of(random_leaves(Crown::kSphere, {0, 0, 2}, Vec3(1), 2000, 0.06, 5), {Leaf{0.5, 0.5}});
  const LightMap map = trace_light(forest, 1.0, skylight(1.0), tight());
  expect_all_lit_by_one(map);
  expect_sound(map, forest);
  EXPECT_NEAR(map.bands[0].budget.absorbed_foliage_w, 0.0, 1e-9);
}

TEST(Furnace, PeriodicCrown) {
  Forest forest =
      forest_of(random_leaves(Crown::kSphere, {0, 0, 2}, Vec3(1), 2000, 0.06, 5), {Leaf{0.6, 0.4}});
  forest.period = Period{{-0.8, -0.7}, {1.6, 1.5}};
  const LightMap map = trace_light(forest, 1.0, skylight(1.0), tight());
  expect_all_lit_by_one(map);
  expect_sound(map, forest);
}

// Discs, triangles, shoots, wood and its mesh, unlike faces, turned and scaled copies.
TEST(Furnace, EverythingAtOnce) {
  Forest forest =
      forest_of(random_leaves(Crown::kSphere, {0, 0, 2}, Vec3(1), 300, 0.15, 5), {Leaf{0.7, 0.3, 1.0}});
  Prototype& tree = forest.prototypes[0];
  for (int i = 0; i < 20; ++i) {
    tree.foliage.push_back(disc({0.1 * i - 1, 0.3, 2}, {0.3, 0.1 * i - 1, 1}, 0.1));
    tree.foliage.push_back(shoot({0.1 * i - 1, -0.3, 2.2}, {0.1, 0.05, 0}, 0.04, 0.03));
    tree.foliage.push_back(triangle({0.1 * i - 1, 0, 1}, {0.1 * i - 0.8, 0.1, 1}, {0.1 * i - 1, 0.2, 1.1}));
  }
  tree.wood.push_back({{0, 0, 0}, {0, 0, 1}, 0.1f, 0.05f, 0});  // open ends: light gets inside
  tree.wood_mesh.push_back({{0, 0, 2.5f}, {0.3f, 0, 2.5f}, {0, 0.3f, 2.6f}, 0});
  forest.instances = {{{0, 0, 0}, {}, 0.0f, 1.0f, {}}, {{1.5, 0.4, 0}, {}, 2.0f, 0.6f, {}}};
  for (const bool periodic : {false, true}) {
    if (periodic) forest.period = Period{{-1, -1}, {3, 2}};
    const LightMap map = trace_light(forest, 1.0, skylight(1.0), tight());
    expect_all_lit_by_one(map);
    expect_sound(map, forest);
  }
}

}  // namespace
}  // namespace sunfleck::test
