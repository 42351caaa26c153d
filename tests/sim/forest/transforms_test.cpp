// Where things stand: instance transforms by hand and by inversion, numbering of elements, bounds and areas
// against sums over world elements, terrain by trigonometry, and what makes a forest invalid.

#include <gtest/gtest.h>

#include <cmath>

#include "sim/base/random.h"
#include "sim/forest/forest.h"
#include "tests/sim/forest/expect_refusal.h"

namespace sunfleck {
namespace {

void expect_near(const Vec3& a, const Vec3& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

// Two prototypes (3 and 2 elements) in five instances, turned, scaled and moved at random (seed 11).
Forest small_forest() {
  Forest forest;
  forest.name = "small";
  forest.materials = {{"beech", {{"PAR", 0.1, 0.05, 0.2}}}};
  RandomStream random(11, 0, RandomPurpose::kTestScene);
  for (const int elements : {3, 2}) {
    Prototype prototype{"p", {"beech"}, {}, {}, {}, 0.2};
    for (int i = 0; i < elements; ++i) {
      const auto at = [&] { return static_cast<float>(random.uniform(-3.0, 3.0)); };
      prototype.foliage.push_back({{at(), at(), at() + 9}, {0.05F, 0, 0}, {0, 0.03F, 0}, 4 * 0.05F * 0.03F});
    }
    forest.prototypes.push_back(prototype);
  }
  for (std::uint32_t i = 0; i < 5; ++i) {
    forest.instances.push_back({{random.uniform(-1e3, 1e3), random.uniform(-1e3, 1e3), random.uniform(0, 9)},
                                {i % 2},
                                static_cast<float>(random.uniform(-7, 7)),
                                static_cast<float>(random.uniform(0.5, 2)),
                                {100 + i}});
  }
  return forest;
}

// A quarter turn counter-clockwise takes east to north; scale 2; then the foot is added.
TEST(InstanceTransform, QuarterTurnByHand) {
  const Instance instance{{10, 20, 30}, {0}, static_cast<float>(kPi / 2), 2.0F, {1}};
  // The yaw is a float: pi/2 to 4.4e-8.
  expect_near(world_from_tree(instance, {1, 0, 5}), {10, 22, 40}, 2e-7);
  expect_near(world_from_tree(instance, {0, 1, 0}), {8, 20, 30}, 2e-7);
  expect_near(world_direction_from_tree(instance, {1, 0, 0}), {0, 1, 0}, 1e-7);
}

TEST(InstanceTransform, ThereAndBackAgain) {
  const Forest forest = small_forest();
  for (const Instance& instance : forest.instances) {
    const Vec3 p{1.5, -2.5, 7.25}, direction = glm::normalize(Vec3{0.3, -0.5, 0.8});
    // Coordinates of 1e3 in double: 1e-13 each, some operations.
    expect_near(tree_from_world(instance, world_from_tree(instance, p)), p, 1e-11);
    expect_near(tree_direction_from_world(instance, world_direction_from_tree(instance, direction)),
                direction, 1e-14);
    EXPECT_NEAR(glm::length(world_direction_from_tree(instance, direction)), 1.0, 1e-14);
  }
}

TEST(ForestIndex, NumbersInstanceByInstance) {
  const Forest forest = small_forest();
  const ForestIndex index(forest);
  EXPECT_EQ(index.element_count(), 3U + 2 + 3 + 2 + 3);
  EXPECT_EQ(index.instance_count(), 5U);
  std::size_t element = 0;
  for (std::uint32_t i = 0; i < 5; ++i) {
    EXPECT_EQ(index.first_element(i), element);
    for (std::uint32_t local = 0; local < (i % 2 == 0 ? 3U : 2U); ++local, ++element) {
      EXPECT_EQ(index.place(element).instance, i);
      EXPECT_EQ(index.place(element).local, local);
    }
  }
}

TEST(Forest, BoundsHoldAllElementsAndAreaIsTheirSum) {
  const Forest forest = small_forest();
  const Box bounds = forest_bounds(forest);
  const ForestIndex index(forest);
  double area_m2 = 0;
  for (std::size_t element = 0; element < index.element_count(); ++element) {
    const auto place = index.place(element);
    const WorldElement world = world_element(forest, place.instance, place.local);
    area_m2 += world.area_m2;
    for (const double u : {-1.0, 1.0}) {
      for (const double v : {-1.0, 1.0}) {
        const Vec3 corner = world.centre_m + u * world.half_u_m + v * world.half_v_m;
        EXPECT_TRUE(glm::all(glm::greaterThanEqual(corner, bounds.lo - 1e-5)) &&
                    glm::all(glm::lessThanEqual(corner, bounds.hi + 1e-5)));
      }
    }
    // Scaled edges span the scaled area (float edges: 1e-6).
    EXPECT_NEAR(4 * glm::length(glm::cross(world.half_u_m, world.half_v_m)), world.area_m2,
                1e-6 * world.area_m2);
  }
  EXPECT_NEAR(forest_leaf_area_m2(forest), area_m2, 1e-9 * area_m2);
}

// A prototype of all kinds of elements and wood, spread at random in a crown.
Prototype random_prototype(RandomStream& random) {
  Prototype prototype{"p", {"beech"}, {}, {}, {}, 0.2};
  const auto within = [&](double r) { return static_cast<float>(random.uniform(-r, r)); };
  for (int i = 0; i < 40; ++i) {
    FoliageElement e;
    e.centre_m = {within(3), within(1.5), within(4) + 9};
    e.half_u_m = {within(0.3), within(0.3), within(0.3)};
    e.half_v_m = {within(0.3), within(0.3), within(0.3)};
    e.shape = static_cast<ElementShape>(i % 4);
    if (e.shape == ElementShape::kDisc)
      e.half_v_m = glm::length(e.half_u_m) * Vec3f(basis_around(glm::normalize(Vec3(e.half_u_m))).tangent);
    e.area_m2 = 1;
    prototype.foliage.push_back(e);
    prototype.wood.push_back({{0, 0, within(1) + 1}, {within(3), within(3), 5}, 0.2F, 0.1F, 0});
  }
  return prototype;
}

// The prototype where the instance stands, in coordinates of the world.
Prototype baked(const Instance& instance, Prototype prototype) {
  const auto moved = [&](Vec3f& p) { p = Vec3f(world_from_tree(instance, p)); };
  const auto turned = [&](Vec3f& v) {
    v = Vec3f(static_cast<double>(instance.scale) * world_direction_from_tree(instance, v));
  };
  for (FoliageElement& e : prototype.foliage) {
    moved(e.centre_m);
    turned(e.half_u_m);
    turned(e.half_v_m);
  }
  for (WoodSegment& s : prototype.wood) {
    moved(s.from_m);
    moved(s.to_m);
    s.radius_from_m *= instance.scale;
    s.radius_to_m *= instance.scale;
  }
  return prototype;
}

// Random prototypes, yaws, scales and places (seed 5): what is baked lies inside, to the rounding of floats
// at 100 m (1e-5 m).
TEST(Forest, BoundsHoldWhatIsBaked) {
  RandomStream random(5, 0, RandomPurpose::kTestScene);
  for (int round = 0; round < 300; ++round) {
    Forest forest;
    forest.prototypes.push_back(random_prototype(random));
    const Vec3 foot{random.uniform(-90, 90), random.uniform(-90, 90), random.uniform(0, 9)};
    const auto yaw = static_cast<float>(random.uniform(-7, 7)),
               scale = static_cast<float>(random.uniform(0.5, 2));
    forest.instances.push_back({foot, {0}, yaw, scale, {1}});
    const Box bounds = forest_bounds(forest);
    const Prototype world = baked(forest.instances[0], forest.prototypes[0]);
    Box inner = prototype_bounds(world);
    for (const FoliageElement& e : world.foliage) inner.include(element_bounds(e));
    EXPECT_TRUE(glm::all(glm::greaterThanEqual(inner.lo, bounds.lo - 2e-5)) &&
                glm::all(glm::lessThanEqual(inner.hi, bounds.hi + 2e-5)))
        << round;
  }
}

// A disc-shaped crown of 3 m radius made of 400 leaves of 5 cm half edge at its rim: at any yaw it is 6.1 m
// wide at most, and its turned box would be up to 6.1 sqrt(2).
TEST(Forest, BoundsOfATurnedRoundCrownAreTight) {
  Forest forest;
  forest.prototypes.push_back({"round", {"beech"}, {}, {}, {}, 0.2});
  for (int i = 0; i < 400; ++i) {
    const double a = 2 * kPi * i / 400;
    const Vec3f out(std::cos(a), std::sin(a), 0), along(-out.y, out.x, 0);
    forest.prototypes[0].foliage.push_back(
        {3.0F * out + Vec3f(0, 0, 9), 0.05F * out, 0.05F * along, 0.01F, ElementShape::kParallelogram, 0, 0});
  }
  for (const float yaw : {0.0F, 0.3F, 0.785F, 2.0F}) {
    forest.instances = {{{50, 60, 7}, {0}, yaw, 1.5F, {1}}};
    const Vec3 size = forest_bounds(forest).size(),
               exact = prototype_bounds(baked(forest.instances[0], forest.prototypes[0])).size();
    for (int axis = 0; axis < 2; ++axis) {
      EXPECT_GE(size[axis], exact[axis] - 1e-4) << yaw;
      EXPECT_LE(size[axis], 1.03 * exact[axis]) << yaw;
    }
  }
}

// Falling 30 degrees towards east (azimuth 90): 10 m east is 10 tan 30 lower, north is level.
TEST(Terrain, FallsTowardsItsAspect) {
  const Terrain terrain{100, kPi / 6, kPi / 2};
  EXPECT_NEAR(terrain.height_at(10, 0), 100 - 10 * std::tan(kPi / 6), 1e-12);
  EXPECT_NEAR(terrain.height_at(0, 50), 100, 1e-12);
  expect_near(terrain.normal(), {std::sin(kPi / 6), 0, std::cos(kPi / 6)}, 1e-15);
}

TEST(Forest, ContentHashSeesEveryPart) {
  const Forest forest = small_forest();
  const std::vector<std::function<void(Forest&)>> changes{
      [](Forest& f) { f.name += "x"; },
      [](Forest& f) { f.materials[0].bands[0].leaf_reflectance += 1e-16 + 1e-9; },
      [](Forest& f) { f.materials[0].bands[0].band = "NIR"; },
      [](Forest& f) { f.prototypes[1].foliage[1].half_v_m.y += 1e-7F; },
      [](Forest& f) {
        f.prototypes[0].wood.push_back({{0, 0, 0}, {0, 0, 1}, 0.1F, 0.1F, 0});
      },
      [](Forest& f) { f.prototypes[0].stated_dbh_m += 1e-9; },
      [](Forest& f) { f.instances[4].yaw_rad += 1e-3F; },
      [](Forest& f) { f.instances[4].tree.value += 1; },
      [](Forest& f) { std::swap(f.instances[0], f.instances[2]); },
      [](Forest& f) { f.terrain.aspect_rad = 1; },
      [](Forest& f) {
        f.period = Period{{0, 0}, {1, 1}};
      },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Forest changed = forest;
    changes[i](changed);
    EXPECT_NE(content_hash(changed), content_hash(forest)) << "change " << i;
  }
  EXPECT_EQ(content_hash(Forest(forest)), content_hash(forest));
}

TEST(Forest, InvalidForestsAreRefused) {
  struct Case {
    const char *where, *problem;
    std::function<void(Forest&)> spoil;
  };
  const float nan = std::nanf("");
  const std::vector<Case> cases{
      {"instance 3", "prototype 2", [](Forest& f) { f.instances[3].prototype.value = 2; }},
      {"instance 1", "scale", [](Forest& f) { f.instances[1].scale = 0; }},
      {"instance 1", "scale", [](Forest& f) { f.instances[1].scale = -1; }},
      {"instance 1", "scale", [&](Forest& f) { f.instances[1].scale = nan; }},
      {"instance 1", "finite", [&](Forest& f) { f.instances[1].yaw_rad = nan; }},
      {"instance 1", "finite", [&](Forest& f) { f.instances[1].position_m.z = nan; }},
      {"terrain", "slope", [](Forest& f) { f.terrain.slope_rad = 1.5; }},
      {"terrain", "slope", [](Forest& f) { f.terrain.slope_rad = -0.1; }},
      {"terrain", "finite", [&](Forest& f) { f.terrain.elevation_m = nan; }},
      {"period", "positive",
       [](Forest& f) {
         f.period = Period{{0, 0}, {0, 5}};
       }},
      {"period", "finite",
       [&](Forest& f) {
         f.period = Period{{nan, 0}, {5, 5}};
       }},
      {"period", "more than 1000 periods",
       [](Forest& f) {
         f.period = Period{{0, 0}, {5, 1e-9}};
       }},
      {"materials.beech.PAR", "outside", [](Forest& f) { f.materials[0].bands[0].leaf_reflectance = -0.1; }},
      {"materials.beech.PAR", "over 1", [](Forest& f) { f.materials[0].bands[0].leaf_reflectance = 0.96; }},
      {"", "", [](Forest& f) { f.prototypes[0].materials[0] = "unknown"; }},
      {"", "", [&](Forest& f) { f.prototypes[0].foliage[0].centre_m.x = nan; }},
      {"", "", [](Forest& f) { f.prototypes[0].foliage[0].material = 7; }},
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    SCOPED_TRACE(i);
    Forest forest = small_forest();
    cases[i].spoil(forest);
    test::expect_refusal([&] { validate(forest); }, ErrorKind::kInvalidInput, cases[i].where,
                         cases[i].problem);
  }
  EXPECT_NO_THROW(validate(small_forest()));
  EXPECT_NO_THROW(validate(Forest{}));
}

}  // namespace
}  // namespace sunfleck
