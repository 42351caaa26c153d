// Rays through instances, periods, shoots, wood and ground.
#include "lighting/trace/ray_scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/base/error.h"
#include "sim/base/random.h"
#include "tests/lighting/trace/scenes.h"

namespace sunfleck::test {
namespace {

Vec3 any_direction(RandomStream& random) {
  const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * kPi), r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

TEST(RayScene, FrontIsWhereTheNormalPoints) {
  const std::vector<FoliageElement> leaves = {quad({0, 0, 1}, {0.3, 0, 0}, {0, 0.3, 0}),
                                              triangle({4.7, -0.3, 1}, {5.3, -0.3, 1}, {5, 0.4, 1}),
                                              disc({10, 0, 1}, {0, 0, 1}, 0.3)};
  Forest forest = forest_of(leaves);
  forest.prototypes[0].wood_mesh.push_back({{14.7f, -0.3f, 1}, {15.3f, -0.3f, 1}, {15, 0.4f, 1}, 0});
  const RayScene scene(forest, {});
  for (const double x : {0.0, 5.0, 10.0, 15.0}) {
    const RayHit down = scene.closest_hit({x, 0, 3}, {0, 0, -1}),
                 up = scene.closest_hit({x, 0, 0.2}, {0, 0, 1});
    EXPECT_EQ(down.kind, x < 15.0 ? HitKind::kFoliage : HitKind::kWoodMesh) << x;
    EXPECT_TRUE(down.front) << x;
    EXPECT_FALSE(up.front) << x;
    EXPECT_NEAR(down.distance_m, 2.0, 1e-5);
    EXPECT_NEAR(down.normal.z, 1.0, 1e-6);
    EXPECT_NEAR(up.normal.z, -1.0, 1e-6);
    EXPECT_EQ(down.local, x < 15.0 ? static_cast<std::uint32_t>(x / 5.0) : 0u);
  }
}

// The same leaves, once as turned, scaled and moved instances of one prototype and once baked into the world.
TEST(RayScene, InstancesAreWhatTheyStandFor) {
  Forest placed = forest_of(random_leaves(Crown::kSphere, {0, 0, 2}, {1, 1, 1.5}, 400, 0.15, 3));
  placed.prototypes[0].wood.push_back({{0, 0, 0}, {0.1f, 0, 2}, 0.1f, 0.05f, 0});
  placed.instances = {{{0, 0, 0}, {}, 0.3f, 1.0f, {}},
                      {{2.5, 0.5, 0.2}, {}, -2.0f, 0.6f, {}},
                      {{-1, 2, 0}, {}, 4.0f, 1.5f, {}}};
  std::vector<FoliageElement> world;
  Forest baked = forest_of({});
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 400; ++k) {
      const WorldElement e = world_element(placed, i, k);
      world.push_back(quad(e.centre_m, e.half_u_m, e.half_v_m));
    }
    const Instance& at = placed.instances[i];
    baked.prototypes[0].wood.push_back({world_from_tree(at, {0, 0, 0}), world_from_tree(at, {0.1, 0, 2}),
                                        0.1f * at.scale, 0.05f * at.scale, 0});
  }
  baked.prototypes[0].foliage = world;
  const RayScene a(placed, {}), b(baked, {});
  RandomStream random(7, 0, RandomPurpose::kTestScene);
  int unlike = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 origin(random.uniform(-3, 4), random.uniform(-3, 4), random.uniform(0, 6)),
        d = any_direction(random);
    const RayHit p = a.closest_hit(origin, d), q = b.closest_hit(origin, d);
    const std::uint32_t per_instance = p.kind == HitKind::kFoliage ? 400 : 1;
    const bool like = p.kind == q.kind && p.front == q.front &&
                      (p.kind == HitKind::kSky || std::abs(p.distance_m - q.distance_m) < 1e-4) &&
                      (p.kind == HitKind::kSky || p.kind == HitKind::kGround ||
                       p.instance * per_instance + p.local == q.local);
    unlike += like ? 0 : 1;  // only rays along an edge may differ
    EXPECT_EQ(a.occluded(origin, d), p.kind != HitKind::kSky);
  }
  EXPECT_LE(unlike, 5);
}

// Trees of all kinds of figures, turned and scaled, their crowns in each other.
Forest interlocked() {
  Forest forest = forest_of(random_leaves(Crown::kSphere, {0, 0, 2}, {1, 1, 1.5}, 300, 0.15, 3));
  Prototype& tree = forest.prototypes[0];
  tree.wood.push_back({{0, 0, 0}, {0.1f, 0, 2}, 0.1f, 0.05f, 0});
  tree.wood_mesh.push_back({{-0.5f, -0.5f, 1}, {0.5f, -0.5f, 1}, {0, 0.5f, 1.2f}, 0});
  for (int i = 0; i < 20; ++i) {
    tree.foliage.push_back(disc({0.1 * i - 1, 0.3, 1 + 0.1 * i}, glm::normalize(Vec3(1, i, 3)), 0.1));
    tree.foliage.push_back(shoot({0.1 * i - 1, -0.3, 1 + 0.1 * i}, {0.2, 0.1, 0}, 0.08, 0.1));
  }
  forest.instances = {{{0, 0, 0}, {}, 0.3f, 1.0f, {}},
                      {{1.2, 0.5, 0.2}, {}, -2.0f, 0.6f, {}},
                      {{-1, 1, 0}, {}, 4.0f, 1.5f, {}}};
  return forest;
}

bool like(const RayHit& a, const RayHit& b) {
  if (a.kind != b.kind) return false;
  if (a.kind == HitKind::kSky) return true;
  return a.front == b.front && a.instance == b.instance && a.local == b.local &&
         std::abs(a.distance_m - b.distance_m) < 1e-4 && glm::length(a.normal - b.normal) < 1e-3;
}

// Many rays: all trees written out into one structure. Lots of needles are drawn from the ray alone, so that
// they fall alike but for rounding.
TEST(RayScene, TreesWrittenOutAreTheSame) {
  for (const bool periodic : {false, true}) {
    Forest forest = interlocked();
    if (periodic) forest.period = Period{{-1, -1}, {3, 3}};
    const RayScene placed(forest, {}), flat(forest, {.expected_rays = 1e9});
    EXPECT_EQ(placed.copies(), flat.copies());
    RandomStream random(7, 0, RandomPurpose::kTestScene);
    int unlike = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vec3 origin(random.uniform(-1, 2), random.uniform(-1, 2), random.uniform(0, 4)),
          d = any_direction(random);
      const RayStart from{HitKind::kFoliage, true, random.below(3), random.below(300)};
      unlike += like(placed.closest_hit(origin, d, 0, from), flat.closest_hit(origin, d, 0, from)) ? 0 : 1;
      unlike += placed.occluded(origin, d, 0, from) == flat.occluded(origin, d, 0, from) ? 0 : 1;
    }
    EXPECT_LE(unlike, 40);  // rays along an edge, and lots on the edge of a needle
  }
}

// Past an instance a ray meets what it would meet were that instance not there, in this period.
TEST(RayScene, RaysPastAnInstance) {
  Forest forest = interlocked();  // without shoots: their lots go by the number of the copy
  std::erase_if(forest.prototypes[0].foliage,
                [](const FoliageElement& e) { return e.shape == ElementShape::kShoot; });
  Forest others = forest;
  others.instances.erase(others.instances.begin() + 1);
  const RayScene without(others, {});
  for (const double expected_rays : {0.0, 1e9}) {
    const RayScene scene(forest, {.expected_rays = expected_rays});
    RandomStream random(8, 0, RandomPurpose::kTestScene);
    int unlike = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vec3 origin(random.uniform(-1, 2), random.uniform(-1, 2), random.uniform(0, 4)),
          d = any_direction(random);
      const RayHit a = scene.closest_hit_past(1, origin, d, {}, 100.0), b = without.closest_hit(origin, d);
      unlike += a.kind == b.kind && (a.kind == HitKind::kSky || std::abs(a.distance_m - b.distance_m) < 1e-4)
                    ? 0
                    : 1;
      EXPECT_EQ(scene.occluded_past(1, origin, d, {}), a.kind != HitKind::kSky);
      const RayHit near = scene.closest_hit_past(1, origin, d, {}, 0.5);
      if (b.distance_m < 0.5) {
        EXPECT_EQ(near.kind, a.kind);
      } else {
        EXPECT_TRUE(near.kind == HitKind::kSky || near.kind == HitKind::kGround);
      }
    }
    EXPECT_LE(unlike, 5);  // only rays along an edge may differ
  }
}

TEST(RayScene, LeafOverThePeriodsBorderComesBackIn) {
  Forest forest = forest_of({quad({0.95, 0, 1}, {0.2, 0, 0}, {0, 0.2, 0})});
  forest.period = Period{{-1, -1}, {2, 2}};
  const RayScene scene(forest, {});
  EXPECT_EQ(scene.copies(), 1u);
  const RayHit hit = scene.closest_hit({-0.9, 0, 2}, {0, 0, -1});  // 1.1 - 2
  EXPECT_EQ(hit.kind, HitKind::kFoliage);
  EXPECT_EQ(hit.instance, 0u);
  EXPECT_NEAR(hit.position_m.x, -0.9, 1e-6);
  EXPECT_EQ(scene.closest_hit({-0.8, 0, 2}, {0, 0, -1}).kind, HitKind::kGround);
  // From five cells away, through the border, by a slanting ray.
  const Vec3 target(0.9 + 2 * 5, -2 * 3, 1), origin(0.1, 0.2, 5);
  const RayHit far = scene.closest_hit(origin, glm::normalize(target - origin));
  EXPECT_EQ(far.kind, HitKind::kFoliage);
  EXPECT_NEAR(far.distance_m, glm::length(target - origin), 1e-5);
  EXPECT_NEAR(far.position_m.x, 0.9, 1e-5);
  EXPECT_NEAR(far.position_m.y, 0.0, 1e-5);
}

// A leaf is not shaded by itself, but by its own copies.
TEST(RayScene, StartIsSkippedInItsOwnCellOnly) {
  Forest forest = forest_of({quad({0.9, 0, 1}, {0, 0.4, 0}, {0, 0, 0.4})});  // faces +x
  const RayStart leaf{HitKind::kFoliage, true, 0, 0};
  {
    const RayScene alone(forest, {});
    EXPECT_TRUE(alone.occluded({0.9 - 1e-3, 0, 1}, {1, 0, 0}));
    EXPECT_FALSE(alone.occluded({0.9 - 1e-3, 0, 1}, {1, 0, 0}, 0.0, leaf));
    EXPECT_FALSE(alone.occluded({0.9 - 1e-3, 0, 1}, {1, 0, 0}, 0.01));
  }
  forest.period = Period{{-1, -1}, {2, 2}};
  const RayScene scene(forest, {});
  const RayHit hit = scene.closest_hit({0.9, 0, 1}, {1, 0, 0}, 0.0, leaf);
  EXPECT_EQ(hit.kind, HitKind::kFoliage);
  EXPECT_FALSE(hit.front);
  EXPECT_NEAR(hit.distance_m, 2.0, 1e-5);
}

TEST(RayScene, GroundAndSlope) {
  Forest forest = forest_of({quad({0, 0, 2}, {0.1, 0, 0}, {0, 0.1, 0})});
  forest.terrain = {0.5, radians_from_degrees(30), radians_from_degrees(90)};  // falls towards the east
  const RayScene scene(forest, {});
  const RayHit hit = scene.closest_hit({3, 1, 10}, {0, 0, -1});
  EXPECT_EQ(hit.kind, HitKind::kGround);
  EXPECT_TRUE(hit.front);
  EXPECT_NEAR(hit.position_m.z, forest.terrain.height_at(3, 1), 1e-9);
  EXPECT_NEAR(glm::length(hit.normal - forest.terrain.normal()), 0.0, 1e-12);
  EXPECT_FALSE(scene.closest_hit({3, 1, -10}, {0, 0, 1}).front);  // from below
  const RayScene no_ground(forest, {.ground = false});
  EXPECT_EQ(no_ground.closest_hit({3, 1, 10}, {0, 0, -1}).kind, HitKind::kSky);
}

// In a period on a slope the copies follow the ground.
TEST(RayScene, PeriodOnASlope) {
  Forest forest = forest_of({quad({0, 0, 2}, {0.2, 0, 0}, {0, 0.2, 0})});
  forest.terrain = {0, radians_from_degrees(20), radians_from_degrees(90)};
  forest.period = Period{{-1, -1}, {2, 2}};
  const RayScene scene(forest, {});
  const double drop = 2.0 * std::tan(radians_from_degrees(20));
  const Vec3 target(4.1, 0.1, 2 - 2 * drop), origin(-0.7, 0.3, 4);
  const RayHit hit = scene.closest_hit(origin, glm::normalize(target - origin));
  EXPECT_EQ(hit.kind, HitKind::kFoliage);
  EXPECT_NEAR(hit.distance_m, glm::length(target - origin), 1e-5);
  EXPECT_NEAR(hit.position_m.z, 2.0, 1e-5);
}

TEST(RayScene, EndlessRaysEnd) {
  Forest forest = forest_of({quad({0, 0, 1}, {0.1, 0, 0}, {0, 0.1, 0})});
  forest.period = Period{{-1, -1}, {2, 2}};
  const RayScene scene(forest, {});
  EXPECT_EQ(scene.closest_hit({0.5, 0.5, 1}, {1, 0, 0}).kind, HitKind::kSky);
  EXPECT_EQ(scene.closest_hit({0.5, 0.5, 1}, glm::normalize(Vec3(1, 0, -1e-12))).kind, HitKind::kGround);
  EXPECT_EQ(scene.closest_hit({0.5, 0.5, 1}, glm::normalize(Vec3(1, 1e-3, 1e-9))).kind, HitKind::kSky);
}

// A shoot of needle area a in a cylinder of volume V lets exp(-a / (2 V) * path) through.
TEST(RayScene, ShootLetsThroughWhatItsNeedlesLeave) {
  const double radius = 0.05, half = 0.1, area = 0.03;
  const double volume = kPi * radius * radius * 2 * half, extinction = 0.5 * area / volume;
  for (const double scale : {1.0, 3.0}) {
    Forest forest = forest_of({shoot({0, 0, 1}, {half, 0, 0}, radius, area)});
    forest.instances[0].scale = static_cast<float>(scale);
    const RayScene scene(forest, {.ground = false});
    const Vec3 centre(0, 0, scale);
    struct Way {
      Vec3 direction, jitter;
      double path;
    };
    // Along the axis, and across it through the middle (rays 1e-9 apart so that each draws its own lot).
    for (const Way& way :
         {Way{{1, 0, 0}, {0, 1e-9, 0}, 2 * half}, Way{{0, 1, 0}, {1e-9, 0, 0}, 2 * radius}}) {
      int through = 0;
      constexpr int kRays = 40000;
      for (int i = 0; i < kRays; ++i)
        through +=
            scene.occluded(centre - 2.0 * way.direction + double(i) * way.jitter, way.direction) ? 0 : 1;
      const double expected = std::exp(-extinction * way.path);  // both area / volume and path scale away
      EXPECT_NEAR(through / double(kRays), expected, 4 * std::sqrt(expected * (1 - expected) / kRays));
    }
  }
}

TEST(RayScene, NeedleHitsRepeatAndLieInside) {
  const Forest forest = forest_of({shoot({0, 0, 1}, {0.1, 0, 0}, 0.05, 0.05)});
  const RayScene scene(forest, {});
  RandomStream random(8, 0, RandomPurpose::kTestScene);
  int fronts = 0, hits = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec3 d = any_direction(random), origin = Vec3(0, 0, 1) - 0.5 * d;
    const RayHit a = scene.closest_hit(origin, d), b = scene.closest_hit(origin, d);
    EXPECT_EQ(a.distance_m, b.distance_m);
    EXPECT_EQ(a.kind == HitKind::kFoliage, scene.occluded(origin, d) && a.kind != HitKind::kGround);
    if (a.kind != HitKind::kFoliage) continue;
    ++hits;
    fronts += a.front ? 1 : 0;
    EXPECT_LT(std::abs(a.position_m.x), 0.1 + 1e-6);
    EXPECT_LT(std::hypot(a.position_m.y, a.position_m.z - 1), 0.05 + 1e-6);
    EXPECT_LT(glm::dot(a.normal, d), 0.0);
  }
  EXPECT_GT(hits, 1000);
  EXPECT_NEAR(fronts, 0.5 * hits, 4 * 0.5 * std::sqrt(hits));  // faces by lot
}

TEST(RayScene, FarFromTheWorldsOriginNothingChanges) {
  const Forest near = forest_of(random_leaves(Crown::kSphere, {0, 0, 2}, Vec3(1), 300, 0.15, 3));
  RandomStream random(7, 0, RandomPurpose::kTestScene);
  for (const double shift : {1e4, 1e6}) {
    Forest moved = near;
    const Vec3 by(shift, -shift, shift);
    moved.instances[0].position_m = by;
    moved.terrain.elevation_m = by.z;
    const RayScene a(near, {}), b(moved, {});
    for (int i = 0; i < 5000; ++i) {
      const Vec3 origin(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(0, 4)),
          d = any_direction(random);
      const RayHit p = a.closest_hit(origin, d), q = b.closest_hit(origin + by, d);
      EXPECT_EQ(p.kind, q.kind);
      EXPECT_EQ(p.local, q.local);
    }
  }
}

TEST(RayScene, EmptyForestIsGroundAndSky) {
  const Forest forest;
  const RayScene scene(forest, {});
  EXPECT_EQ(scene.closest_hit({0, 0, 1}, {0, 0, -1}).kind, HitKind::kGround);
  EXPECT_EQ(scene.closest_hit({0, 0, 1}, {0, 0, 1}).kind, HitKind::kSky);
  EXPECT_EQ(scene.copies(), 0u);
}

}  // namespace
}  // namespace sunfleck::test
