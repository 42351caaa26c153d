// Trees kept in a table give the same hits as Embree's own instances of them.
#include <gtest/gtest.h>

#include <cmath>

#include "lighting/trace/ray_scene.h"
#include "sim/base/random.h"
#include "tests/lighting/trace/scenes.h"

namespace sunfleck::test {
namespace {

constexpr std::size_t kAlways = 1, kNever = 1'000'000'000;

// Leaves, shoots and wood in two prototypes and an empty one; 300 trees of any turn and size around a place
// far from the world's origin.
Forest many_trees() {
  Forest forest = forest_of(random_leaves(Crown::kSphere, {0, 0, 4}, {1.5, 1.5, 2}, 300, 0.2, 3));
  forest.prototypes[0].wood.push_back({{0, 0, 0}, {0.1f, 0, 5}, 0.1f, 0.02f, 0});
  Prototype conifer = forest.prototypes[0];
  conifer.foliage.clear();
  RandomStream random(5, 0, RandomPurpose::kTestScene);
  for (int i = 0; i < 100; ++i)
    conifer.foliage.push_back(shoot({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(1, 6)},
                                    {0.1, 0.05, 0.02}, 0.05, 0.01));
  forest.prototypes.push_back(conifer);
  forest.prototypes.push_back({"empty", forest.prototypes[0].materials, {}, {}, {}, 0});
  forest.instances.clear();
  for (std::uint32_t i = 0; i < 300; ++i) {
    Instance tree;
    tree.position_m = {5e5 + random.uniform(0, 60), 1e5 + random.uniform(0, 60), 0};
    tree.prototype.value = i < 280 ? static_cast<std::uint32_t>(random.below(2)) : 2;
    tree.yaw_rad = static_cast<float>(random.uniform(-4, 4));
    tree.scale = static_cast<float>(random.uniform(0.5, 1.6));
    forest.instances.push_back(tree);
  }
  return forest;
}

struct TestRay {
  Vec3 origin, direction;
};
TestRay any_ray(RandomStream& random) {
  const double z = random.uniform(-1, 0.4), turn = random.uniform(0, 2 * kPi), r = std::sqrt(1 - z * z);
  return {{5e5 + random.uniform(-5, 65), 1e5 + random.uniform(-5, 65), random.uniform(0.1, 12)},
          {r * std::cos(turn), r * std::sin(turn), z}};
}

TEST(InstanceTable, SameHitsAsEmbreesInstances) {
  const Forest forest = many_trees();
  const RayScene own(forest, {.table_from = kNever}), table(forest, {.table_from = kAlways});
  RandomStream random(9, 0, RandomPurpose::kTestScene);
  int foliage = 0, wood = 0, differ = 0;
  constexpr int kRays = 20'000;
  for (int i = 0; i < kRays; ++i) {
    const TestRay ray = any_ray(random);
    const RayHit a = own.closest_hit(ray.origin, ray.direction),
                 b = table.closest_hit(ray.origin, ray.direction);
    EXPECT_EQ(own.occluded(ray.origin, ray.direction), a.kind != HitKind::kSky);
    EXPECT_EQ(table.occluded(ray.origin, ray.direction), b.kind != HitKind::kSky);
    foliage += a.kind == HitKind::kFoliage;
    wood += a.kind == HitKind::kWood;
    if (a.kind != b.kind || a.instance != b.instance || a.local != b.local) {
      ++differ;
      continue;
    }
    if (a.kind == HitKind::kSky) continue;
    // Across the surface: along it a grazing ray moves far by little rounding.
    ASSERT_NEAR(glm::dot(a.position_m - b.position_m, a.normal), 0, 1e-4);
    ASSERT_EQ(a.front, b.front);
    ASSERT_GT(glm::dot(a.normal, b.normal), 1 - 1e-4);
  }
  EXPECT_GT(foliage, kRays / 8);
  EXPECT_GT(wood, kRays / 200);
  // Rays that graze an edge may go either way by the rounding of single precision, which is 4e-6 m here.
  EXPECT_LE(differ, kRays / 2000);
}

// A ray that starts on a leaf or on wood does not meet it again.
TEST(InstanceTable, RaysLeaveWhatTheyStartOn) {
  const Forest forest = many_trees();
  const RayScene table(forest, {.table_from = kAlways});
  RandomStream random(10, 0, RandomPurpose::kTestScene);
  int starts = 0;
  for (int i = 0; i < 5000; ++i) {
    const TestRay ray = any_ray(random);
    const RayHit hit = table.closest_hit(ray.origin, ray.direction);
    if (hit.kind != HitKind::kFoliage && hit.kind != HitKind::kWood) continue;
    if (hit.kind == HitKind::kWood && !hit.front) continue;  // meets its other inner side
    if (forest.instances[hit.instance].prototype.value == 1 && hit.kind == HitKind::kFoliage)
      continue;  // shoots
    const RayStart from{hit.kind, hit.front, hit.instance, hit.local};
    const RayHit next = table.closest_hit(hit.position_m, hit.normal, 0.0, from);
    ++starts;
    EXPECT_FALSE(next.kind == hit.kind && next.instance == hit.instance && next.local == hit.local);
  }
  EXPECT_GT(starts, 500);
}

TEST(InstanceTable, ATreeCostsLessThanAHundredBytes) {
  Forest forest = many_trees();
  const std::vector<Instance> some = forest.instances;
  const auto bytes_of = [&](std::size_t trees) {
    forest.instances.clear();
    for (std::size_t i = 0; i < trees; ++i) {
      forest.instances.push_back(some[i % some.size()]);
      forest.instances.back().prototype.value = 0;
      forest.instances.back().position_m += 70.0 * Vec3(static_cast<double>(i / some.size()), 0, 0);
    }
    return RayScene(forest, {.table_from = kAlways}).memory_bytes() +
           forest.instances.size() * sizeof(Instance);
  };
  const std::size_t few = bytes_of(3000), many = bytes_of(63'000);
  EXPECT_LE(static_cast<double>(many - few) / 60'000, 100.0);
}

}  // namespace
}  // namespace sunfleck::test
