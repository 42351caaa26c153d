// All slab methods at the edges of what can be asked: every answer is finite, >= 0, and no
// leaf gets more than closed forms allow.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim/base/error.h"
#include "tests/lighting/slab/estimator_scene.h"

namespace sunfleck {
namespace {

using namespace test;

struct Scene {
  std::string name;
  Forest forest;
};

Forest with_leaf_size(double half_side_m, double spacing_m) {
  std::vector<FoliageElement> leaves;
  for (int i = 0; i < 30; ++i)
    leaves.push_back(square_leaf({spacing_m * (i % 3), spacing_m * (i / 3 % 3), 2 + spacing_m * (i / 9)},
                                 {half_side_m, 0, 0.2 * half_side_m * (i % 4)}, {0, half_side_m, 0}));
  return forest_of(std::move(leaves));
}

Forest moved(Forest forest, const Vec3& by) {
  for (Instance& tree : forest.instances) tree.position_m += by;
  return forest;
}

Forest periodic(Forest forest, double size_m) {
  forest.period = Period{{0, 0}, {size_m, size_m}};
  return forest;
}

Forest on_slope(Forest forest, double slope_deg) {
  forest.terrain.slope_rad = radians_from_degrees(slope_deg);
  forest.terrain.aspect_rad = 1.0;
  return forest;
}

Forest wood_only() {
  Forest forest = forest_of({});
  forest.prototypes[0].wood = {{Vec3f(0, 0, 0), Vec3f(0, 0, 5), 0.2f, 0.1f, 0}};
  return forest;
}

Forest leaf_in_a_stem() {
  Forest forest = forest_of({square_leaf({0, 0, 2}, {0.05, 0, 0}, {0, 0.05, 0})});
  forest.prototypes[0].wood = {{Vec3f(0, 0, 0), Vec3f(0, 0, 5), 0.5f, 0.5f, 0}};
  forest.prototypes[0].wood_mesh = {{Vec3f(-1, -1, 3), Vec3f(1, -1, 3), Vec3f(0, 1, 3), 0}};
  return forest;
}

Forest mixed_shapes() {
  Forest forest = generated_crown({CrownKind::kSphere, 60, 1.0, 2.0, 6});
  int i = 0;
  for (FoliageElement& e : forest.prototypes[0].foliage) {
    e.shape = static_cast<ElementShape>(i++ % 4);
    if (e.shape != ElementShape::kShoot) e.area_m2 = static_cast<float>(element_geometric_area(e));
  }
  return forest;
}

std::vector<Scene> scenes() {
  Forest nothing = forest_of({});
  nothing.instances.clear();
  const FoliageElement leaf = square_leaf({0, 0, 2}, {0.05, 0, 0}, {0, 0.05, 0});
  const FoliageElement upright = square_leaf({0, 0, 2}, {0, 0.05, 0}, {0, 0, 0.05});
  const FoliageElement none = square_leaf({0, 0, 2}, Vec3(0.0), Vec3(0.0));
  const Forest crown = generated_crown({CrownKind::kSphere, 300, 1.0, 5.0, 7});
  Forest flat = crown;
  for (FoliageElement& e : flat.prototypes[0].foliage) e.centre_m.z = 1.0f;
  return {{"no tree", nothing},
          {"no leaf", forest_of({})},
          {"wood only", wood_only()},
          {"leaf in a stem", leaf_in_a_stem()},
          {"one leaf", forest_of({leaf})},
          {"one upright leaf", forest_of({upright})},
          {"a leaf of no area", forest_of({none, leaf})},
          {"coincident leaves", forest_of(std::vector<FoliageElement>(50, leaf))},
          {"leaves of 1 mm", with_leaf_size(0.5e-3, 2e-3)},
          {"leaves of 1 km", with_leaf_size(500, 300)},
          {"dense leaves", with_leaf_size(0.5, 1e-6)},
          {"flat crown", flat},
          {"mixed shapes", mixed_shapes()},
          {"far away", moved(crown, {1e6, -1e6, 1e3})},
          {"periodic", periodic(crown, 2.5)},
          {"overhanging period", periodic(crown, 0.7)},
          {"steep slope", on_slope(crown, 75)},
          {"periodic slope", periodic(on_slope(crown, 20), 3)}};
}

std::vector<Vec3> suns() {
  const double eps = 1e-9;
  return {{0, 0, 1},
          {1, 0, 0},
          {0, 1, eps},
          glm::normalize(Vec3(-1, 0, eps)),
          glm::normalize(Vec3(-1, 0, -eps)),
          {0, 0, -1},
          glm::normalize(Vec3(1, 1, 1)),
          glm::normalize(Vec3(0, -1, 0.05))};
}

// What the faces of a leaf get together: of a source of normal irradiance E at most E directly and (D + U) /
// 2
// <= E scattered; the sky's sources add up to at most 4 diffuse horizontal irradiances (11 directions, mean
// cosine over 1/4). Half a percent for float.
void expect_sound(const Scene& scene, const OpticsTable& optics, const Illumination& light,
                  SppVariant variant) {
  const LightMap map = estimate(scene.forest, optics, light, variant);
  const ForestIndex index(scene.forest);
  ASSERT_EQ(find_violation(map, index), "") << scene.name;
  const BandLight& strength = light.bands[0];
  // SPP-H moves light of an upright source into the whole hemisphere and back, up to 4 times as much (fluence
  // of a white slab over a white ground, m = 1/2); the refined form gathers from few directions, which may
  // all be bright.
  const bool roomy = variant == SppVariant::kSppH || variant == SppVariant::kSppMarched;
  const double most =
      (roomy ? 4.0 : 1.005) * (2 * strength.beam_normal_w_m2 + 8 * strength.diffuse_horizontal_w_m2);
  for (const ElementLight& e : map.bands[0].elements)
    ASSERT_LE(e.front.total() + e.back.total(), most) << scene.name;
  if (light.sun_is_up()) return;
  for (const ElementLight& e : map.bands[0].elements) ASSERT_EQ(e.front.direct_w_m2, 0.0f) << scene.name;
}

TEST(SppStress, EveryAnswerIsSound) {
  struct Leaf {
    double reflectance, transmittance, soil;
  };
  for (const Scene& scene : scenes())
    for (const Leaf& leaf :
         {Leaf{0, 0, 0}, Leaf{0.5, 0.5, 1}, Leaf{1, 0, 1}, Leaf{0, 1, 0}, Leaf{0.1, 0.05, 0.2}}) {
      const OpticsTable optics = optics_of(scene.forest, leaf.reflectance, leaf.transmittance, leaf.soil);
      for (const Vec3& sun : suns())
        for (const SppVariant variant : kAllVariants)
          expect_sound(scene, optics, light_of(sun, 1000, 300, SkyModel::kStandardOvercast), variant);
    }
}

TEST(SppStress, BadNumbersAreRefused) {
  const Forest forest = generated_crown({CrownKind::kSphere, 50, 1.0, 3.0, 7});
  const OpticsTable optics = optics_of(forest, 0.4, 0.4);
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  std::vector<Illumination> bad{light_of({nan, 0, 1}, 1, 1), light_of({0, 0, inf}, 1, 1),
                                light_of({0, 0, 0}, 1, 1),   light_of({0, 0, 1}, nan, 1),
                                light_of({0, 0, 1}, 1, inf), light_of({0, 0, 1}, -1, 1)};
  for (const Illumination& light : bad)
    for (const SppVariant variant : kAllVariants)
      EXPECT_THROW(estimate(forest, optics, light, variant), Error);
}

// Strengths over decades, sources off.
TEST(SppStress, StrengthsOverDecades) {
  const Scene scene{"crown", generated_crown({CrownKind::kSphere, 300, 1.0, 5.0, 7})};
  const OpticsTable optics = optics_of(scene.forest, 0.45, 0.45, 0.1);
  for (const double beam : {0.0, 1e-20, 1.0, 1e9})
    for (const double diffuse : {0.0, 1e-20, 1.0, 1e9})
      for (const SppVariant variant : kAllVariants)
        expect_sound(scene, optics, light_of(sun_at(50), beam, diffuse), variant);
}

}  // namespace
}  // namespace sunfleck
