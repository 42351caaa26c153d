#include "tests/sim/grid/sample_forests.h"

#include <cmath>
#include <numbers>

#include "sim/base/random.h"

namespace sunfleck::test {

namespace {

Material material(const std::string& name) {
  return {name, {{"PAR", 0.1, 1.0 / 3.0, std::numbers::pi / 10.0}, {"NIR", 0.4123456789012345, 0.5, 0.3}}};
}

// A flat or shoot element of random place and orientation, whose stated area is that of its edges.
FoliageElement random_element(RandomStream& random, ElementShape shape, double crown_radius_m) {
  FoliageElement element;
  const auto coordinate = [&] { return static_cast<float>(random.uniform(-crown_radius_m, crown_radius_m)); };
  element.centre_m = {coordinate(), coordinate(), coordinate() + 2 * static_cast<float>(crown_radius_m)};
  const double yaw = random.uniform(0.0, 2.0 * kPi), size = random.uniform(0.02, 0.06);
  element.half_u_m = Vec3f(size * Vec3(std::cos(yaw), std::sin(yaw), 0.0));
  element.half_v_m = Vec3f(size * Vec3(-std::sin(yaw), std::cos(yaw), 0.0));
  element.shape = shape;
  element.area_m2 =
      shape == ElementShape::kShoot ? 0.01F : static_cast<float>(element_geometric_area(element));
  return element;
}

Prototype varied_prototype(const std::string& name, std::uint64_t seed) {
  RandomStream random(seed, 0, RandomPurpose::kTestScene);
  Prototype prototype{name, {"Fagus sylvatica", "Pinus sylvestris"}, {}, {}, {}, 0.1 + 0.2};
  for (int i = 0; i < 500; ++i) {
    prototype.foliage.push_back(random_element(random, static_cast<ElementShape>(i % 4), 3.0));
    prototype.foliage.back().material = static_cast<std::uint16_t>(i % 2);
  }
  prototype.foliage[7].centre_m = {-0.0F, 1e-42F, 3.0F};  // signed zero and a denormal number
  for (int i = 0; i < 40; ++i) {
    const auto z = static_cast<float>(i) * 0.1F;
    prototype.wood.push_back({{0, -0.0F, z}, {0, 0, z + 0.1F}, 0.2F - z * 0.03F, 0.19F - z * 0.03F, 1});
  }
  prototype.wood_mesh.push_back({{0, 0, 0}, {1, 0, 0}, {0, 1, 1.0F / 3.0F}, 0});
  prototype.wood_mesh.push_back({{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1});
  return prototype;
}

}  // namespace

Forest varied_forest() {
  Forest forest;
  forest.name = "mixed \"stand\", süd\n";
  forest.materials = {material("Fagus sylvatica"), material("Pinus sylvestris"), {"unused", {}}};
  forest.prototypes = {varied_prototype("beech A", 1), varied_prototype("beech A", 2)};
  RandomStream random(3, 0, RandomPurpose::kTestScene);
  for (std::uint32_t i = 0; i < 300; ++i) {
    forest.instances.push_back({{random.uniform(-50.0, 1e6), random.uniform(0.0, 100.0), 1.0 / 3.0},
                                {i % 2},
                                static_cast<float>(random.uniform(0.0, 6.3)),
                                static_cast<float>(random.uniform(0.85, 1.15)),
                                {0xFFFFFFF0U + i % 16}});
  }
  forest.terrain = {312.7, 0.2, 4.0};
  forest.period = Period{{-1.1, 0.3}, {100.1, 50.7}};
  return forest;
}

Forest large_forest(std::size_t elements) {
  Forest forest;
  forest.name = "large";
  forest.materials = {material("Fagus sylvatica")};
  forest.prototypes.push_back({"large crown", {"Fagus sylvatica"}, {}, {}, {}, 0.5});
  RandomStream random(4, 0, RandomPurpose::kTestScene);
  for (std::size_t i = 0; i < elements; ++i) {
    forest.prototypes[0].foliage.push_back(random_element(random, ElementShape::kParallelogram, 5.0));
  }
  forest.instances.push_back({{0, 0, 0}, {0}, 0, 1, {1}});
  return forest;
}

Forest empty_forest() {
  Forest forest;
  forest.name = "";
  return forest;
}

Forest leafless_forest() {
  Forest forest;
  forest.name = "winter";
  forest.materials = {material("Fagus sylvatica")};
  forest.prototypes.push_back(
      {"stem", {"Fagus sylvatica"}, {}, {{{0, 0, 0}, {0, 0, 9}, 0.2F, 0.1F, 0}}, {}, 0.4});
  forest.prototypes.push_back({"nothing", {}, {}, {}, {}, 0.0});
  forest.instances.push_back({{2, 3, 0}, {1}, 0, 1, {5}});
  return forest;
}

}  // namespace sunfleck::test
