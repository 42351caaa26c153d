// Scenes, suns and leaves at the limits of physics and arithmetic through the whole envelope estimator: every
// combination must give finite light, never negative, sunlit shares in [0, 1], and no leaf more sun than
// there is; input that is no number must be refused.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <memory>

#include "lighting/base/summaries.h"
#include "sim/base/error.h"
#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"
#include "tests/lighting/envelope/scenes.h"

namespace sunfleck {
namespace {

using test::forest_of;
using test::light_of;
using test::square_leaf;

Forest scaled_crown(double lai, float scale, const Vec3& position = Vec3(0.0)) {
  Forest forest = generated_crown({.leaves = 400, .crown_lai = lai, .seed = 3});
  forest.instances[0].scale = scale;
  forest.instances[0].position_m = position;
  forest.terrain.elevation_m = position.z;
  return forest;
}

Forest flat_crown() {
  std::vector<FoliageElement> leaves;
  for (int i = 0; i < 400; ++i) {
    RandomStream r(1, static_cast<std::uint64_t>(i), RandomPurpose::kTestScene);
    leaves.push_back(square_leaf({r.uniform(-1, 1), r.uniform(-1, 1), 1.0}, {0, 0, 1}, 0.1));
  }
  return forest_of(leaves);
}

Forest with_shoots(Forest forest, float length_m, float radius_m, float needles_m2) {
  for (FoliageElement& e : forest.prototypes[0].foliage) {
    e.shape = ElementShape::kShoot;
    e.half_u_m = glm::normalize(e.half_u_m) * (0.5f * length_m);
    e.half_v_m = glm::normalize(e.half_v_m) * radius_m;
    e.area_m2 = needles_m2;
  }
  return forest;
}

Forest with_stem(Forest forest) {
  forest.prototypes[0].wood = {
      {.from_m = {0, 0, 0}, .to_m = {0, 0, 2}, .radius_from_m = 0.3f, .radius_to_m = 0.0f},
      {.from_m = {0, 0, 1}, .to_m = {0, 0, 1}, .radius_from_m = 0.1f, .radius_to_m = 0.1f}};
  forest.prototypes[0].wood_mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 0},
                                    {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 0}};
  return forest;
}

Forest two_far_apart() {
  Forest forest = scaled_crown(3, 1);
  forest.instances.push_back(forest.instances[0]);
  forest.instances[1].position_m = {1e6, -1e6, 0};
  return forest;
}

Forest without_area() {
  Forest forest = scaled_crown(3, 1);
  for (FoliageElement& e : forest.prototypes[0].foliage) {
    e.half_u_m = e.half_v_m = {0, 0, 0};
    e.area_m2 = 0;
  }
  return forest;
}

Forest sloped(double slope_rad) {
  Forest forest = generated_layer({.lai = 3, .leaves = 500});
  forest.terrain = {.elevation_m = -20, .slope_rad = slope_rad, .aspect_rad = 0.3};
  return forest;
}

const std::map<std::string, std::function<Forest()>> kScenes = {
    {"one leaf",
     [] {
       return forest_of({square_leaf({0, 0, 1}, {0, 0, 1}, 0.1)});
     }},
    {"one leaf edge-on to x",
     [] {
       return forest_of({square_leaf({0, 0, 1}, {0, 1, 0}, 0.1)});
     }},
    {"one leaf on the ground",
     [] {
       return forest_of({square_leaf({0, 0, 0}, {0, 0, 1}, 0.1)});
     }},
    {"one leaf below the ground",
     [] {
       return forest_of({square_leaf({0, 0, -3}, {0, 0, 1}, 0.1)});
     }},
    {"two leaves in one place",
     [] {
       return forest_of({square_leaf({0, 0, 1}, {1, 2, 3}, 0.1), square_leaf({0, 0, 1}, {1, 2, 3}, 0.1)});
     }},
    {"500 leaves in one place",
     [] {
       return forest_of(std::vector(500, square_leaf({0, 0, 1}, {1, 2, 3}, 0.1)));
     }},
    {"flat crown", flat_crown},
    {"optical depth 1e-9", [] { return scaled_crown(1e-9, 1); }},
    {"optical depth 1e3", [] { return scaled_crown(1e3, 1); }},
    {"optical depth 1e6", [] { return scaled_crown(1e6, 1); }},
    {"leaves of 1e-3 m", [] { return scaled_crown(3, 6e-3f); }},
    {"leaves of 1e3 m", [] { return scaled_crown(3, 6e3f); }},
    {"at 1e6 m",
     [] {
       return scaled_crown(3, 1, {1e6, -1e6, 1e3});
     }},
    {"1e6 m apart", two_far_apart},
    {"no area", without_area},
    {"tiny and giant leaf",
     [] {
       return forest_of({square_leaf({0, 0, 1}, {1, 0, 1}, 1e-4), square_leaf({0, 0, 50}, {0, 0, 1}, 80)});
     }},
    {"shoots", [] { return with_shoots(scaled_crown(3, 1), 0.1f, 0.02f, 1e-3f); }},
    {"shoots without length", [] { return with_shoots(scaled_crown(3, 1), 0.0f, 0.02f, 1e-3f); }},
    {"shoots of solid needles", [] { return with_shoots(scaled_crown(3, 1), 0.1f, 1e-4f, 10.0f); }},
    {"wood", [] { return with_stem(scaled_crown(3, 1)); }},
    {"thin repeating layer", [] { return generated_layer({.lai = 1e-6, .leaves = 20}); }},
    {"dense repeating layer", [] { return generated_layer({.lai = 100, .leaves = 500}); }},
    {"repeating slope", [] { return sloped(0.5); }},
    {"repeating cliff", [] { return sloped(radians_from_degrees(80)); }},
};

std::vector<Vec3> suns() {
  std::vector<Vec3> directions = {
      {0, 0, 1},    {1, 0, 0},     {0, -1, 0},       {1, 0, 1e-9},  {1, 0, -1e-9}, {0, 1, 1e-30},   {1, 1, 1},
      {-1, -1, -1}, {1e-12, 0, 1}, {0.3, 0.4, 1e-3}, {1e-30, 1, 0}, {0, 0, -1.0},  {0.3, -0.5, 0.6}};
  return directions;
}

struct LeafCase {
  const char* name;
  LeafOptics leaf;
  double soil;
};
const LeafCase kLeaves[] = {{"black", {0, 0, 0, 0}, 0},
                            {"conservative", {0.5, 0.5, 0.5, 0.5}, 1},
                            {"mirror and glass", {1, 0, 0, 1}, 0.5},
                            {"faint", {1e-12, 1e-12, 1e-300, 0}, 1e-9}};

// No face gets more sun than a plane facing it, and no more sky than the brightest sky gives.
void expect_bounded(const LightMap& map, double beam, double diffuse) {
  for (const ElementLight& e : map.bands[0].elements) {
    for (const FaceLight& f : {e.front, e.back}) {
      ASSERT_LE(f.direct_w_m2, beam * (1 + 1e-6));
      ASSERT_LE(f.sky_w_m2, diffuse * (1 + 1e-6));
    }
  }
}

// A forest's light under any optics and sky; `of` does once what these do not change.
using LightOf = std::function<LightMap(const OpticsTable&, const Illumination&)>;
struct Method {
  const char* name;
  std::function<LightOf(const Forest&)> of;
};

std::vector<Method> methods() {
  const auto published = [](EnvelopeSun sun) {
    return [sun](const Forest& f) -> LightOf {
      return
          [&f, sun](const OpticsTable& o, const Illumination& l) { return test::envelope_map(f, o, l, sun); };
    };
  };
  const auto full = [](const Forest& f) -> LightOf {
    EnvelopeFullOptions options;
    options.directions = 8;
    const auto prepared = std::make_shared<EnvelopePrepared>(prepare_envelope(f, options, {}));
    return [&f, prepared](const OpticsTable& o, const Illumination& l) {
      return envelope_full_light_map(f, o, l, *prepared, {});
    };
  };
  return {{"published", published(EnvelopeSun::kPublished)},
          {"marched", published(EnvelopeSun::kMarched)},
          {"full", full}};
}

class Stress : public testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(AllMethods, Stress, testing::ValuesIn(methods()),
                         [](const auto& one) { return std::string(one.param.name); });

TEST_P(Stress, EveryResultKeepsTheInvariants) {
  std::size_t runs = 0;
  for (const auto& [name, make] : kScenes) {
    const Forest forest = make();
    const ForestIndex index(forest);
    const LightOf light_map = GetParam().of(forest);
    for (const LeafCase& leaf : kLeaves) {
      const OpticsTable optics(
          forest,
          {.bands = {"VIS"}, .soil_albedo = {leaf.soil}, .overrides = {{"*", "VIS", {leaf.leaf, 1.0}}}});
      for (const Vec3& sun : suns()) {
        const LightMap map = light_map(optics, light_of(sun, 1e3, 1e2));
        ASSERT_EQ(find_violation(map, index), "")
            << name << ", " << leaf.name << ", sun " << sun.x << " " << sun.y << " " << sun.z;
        expect_bounded(map, 1e3, 1e2);
        ++runs;
      }
    }
  }
  std::cout << runs << " runs\n";
}

TEST_P(Stress, GrazingSunIsTheLimitOfALowSun) {
  // Elevation +1e-9 and +1e-6 differ by nothing that light could show.
  const Forest forest = generated_crown({.leaves = 2000});
  const OpticsTable optics = test::optics_of(forest, {"VIS"}, 0.2);
  const LightMap a = GetParam().of(forest)(optics, light_of({1, 0.2, 1e-9}, 500, 0));
  const LightMap b = GetParam().of(forest)(optics, light_of({1, 0.2, 1e-6}, 500, 0));
  for (std::size_t i = 0; i < 2000; ++i)
    ASSERT_NEAR(a.bands[0].elements[i].front.total(), b.bands[0].elements[i].front.total(), 0.05);
}

TEST(StressInput, WhatIsNoNumberIsRefused) {
  const auto refused = [](const Forest& forest) {
    const Forest good = scaled_crown(3, 1);
    const OpticsTable optics = test::optics_of(good, {"VIS"}, 0.2);
    try {
      test::envelope_map(forest, optics, light_of({0, 0, 1}, 1, 1));
    } catch (const Error& error) {
      return error.kind() == ErrorKind::kInvalidInput && !error.remedy().empty();
    }
    return false;
  };
  for (const double bad :
       {static_cast<double>(NAN), static_cast<double>(INFINITY), -static_cast<double>(INFINITY)}) {
    Forest position = scaled_crown(3, 1), leaf = scaled_crown(3, 1), area = scaled_crown(3, 1);
    position.instances[0].position_m.y = bad;
    leaf.prototypes[0].foliage[7].centre_m.x = static_cast<float>(bad);
    area.prototypes[0].foliage[7].area_m2 = static_cast<float>(bad);
    EXPECT_TRUE(refused(position)) << bad;
    EXPECT_TRUE(refused(leaf)) << bad;
    EXPECT_TRUE(refused(area)) << bad;
  }
}

}  // namespace
}  // namespace sunfleck
