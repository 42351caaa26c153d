// What holds for every scene: light adds up over sources and scales with them, moving or turning the scene
// changes nothing, trees that are baked or placed get the same light. And the extremes: tiny and huge leaves,
// albedo 0 and 1, a sun on the horizon, leaves seen edge-on or lying on each other.
#include <gtest/gtest.h>

#include <cmath>

#include "lighting/base/summaries.h"
#include "sim/base/random.h"
#include "tests/lighting/trace/scenes.h"

namespace sunfleck::test {
namespace {

Forest mixed_tree() {
  Forest forest =
      forest_of(random_leaves(Crown::kSphere, {0, 0, 2}, Vec3(1), 200, 0.2, 3), {Leaf{0.4, 0.3, 0.2}});
  auto& foliage = forest.prototypes[0].foliage;
  for (int i = 0; i < 20; ++i) {
    foliage.push_back(disc({0.1 * i - 1, 0.3, 2}, {0.3, 0.1 * i - 1, 1}, 0.1));
    foliage.push_back(shoot({0.1 * i - 1, -0.3, 2.2}, {0.1, 0.05, 0}, 0.04, 0.03));
  }
  forest.prototypes[0].wood.push_back({{0, 0, 0}, {0, 0, 2}, 0.1f, 0.05f, 0});
  forest.prototypes[0].wood_mesh.push_back({{0, 0, 2.5f}, {0.3f, 0, 2.5f}, {0, 0.3f, 2.6f}, 0});
  return forest;
}

double total(const ElementLight& e) { return static_cast<double>(e.front.total()) + e.back.total(); }

TEST(Invariant, SourcesAddUpAndScale) {
  const Forest forest = mixed_tree();
  ReferenceOptions o;
  o.convergence = 1e-7;
  const Vec3 sun(1, 0.3, 2);
  const LightMap both = trace_light(forest, 0.3, sunlight(sun, 400, 100), o);
  const LightMap beam = trace_light(forest, 0.3, sunlight(sun, 400, 0), o);
  const LightMap sky = trace_light(forest, 0.3, sunlight(sun, 0, 100), o);
  const LightMap strong = trace_light(forest, 0.3, sunlight(sun, 4e5, 1e5), o);
  for (std::size_t i = 0; i < both.bands[0].elements.size(); ++i) {
    const double all = total(both.bands[0].elements[i]);
    EXPECT_NEAR(total(beam.bands[0].elements[i]) + total(sky.bands[0].elements[i]), all, 2e-6 * all + 1e-4);
    EXPECT_NEAR(total(strong.bands[0].elements[i]), 1000.0 * all, 2e-3 * all + 0.1);
  }
  expect_sound(both, forest);
}

// The same tree, period and sun far from the world's origin: the same rays, to rounding of coordinates.
TEST(Invariant, MovingTheSceneChangesNothing) {
  for (const bool periodic : {false, true}) {
    Forest forest = mixed_tree();
    if (periodic) forest.period = Period{{-0.8, -0.8}, {1.7, 1.6}};
    const Illumination light = sunlight({1, 0.3, 2}, 400, 100);
    const LightMap here = trace_light(forest, 0.3, light, {});
    for (const double shift : {1e4, 1e6}) {
      Forest moved = forest;
      moved.instances[0].position_m = {shift, -shift, 0.5 * shift};
      moved.terrain.elevation_m = 0.5 * shift;
      if (periodic) moved.period->origin_m += Vec2(shift, -shift);
      const LightMap there = trace_light(moved, 0.3, light, {});
      double worst = 0.0, squares = 0.0;
      for (std::size_t i = 0; i < here.bands[0].elements.size(); ++i) {
        const double z =
            (total(here.bands[0].elements[i]) - total(there.bands[0].elements[i])) /
            std::hypot(here.bands[0].standard_error_w_m2[i], there.bands[0].standard_error_w_m2[i]);
        worst = std::max(worst, std::abs(z));
        squares += z * z / static_cast<double>(here.bands[0].elements.size());
      }
      // Shoots draw other lots from moved coordinates; flat leaves keep all but a ray or two in ten thousand.
      EXPECT_LT(std::sqrt(squares), 0.45) << shift;
      EXPECT_LT(worst, 4.0) << shift;
      EXPECT_NEAR(there.bands[0].mean_irradiance_w_m2, here.bands[0].mean_irradiance_w_m2,
                  4 * here.bands[0].mean_irradiance_standard_error_w_m2);
    }
  }
}

// Turning instance, sun and nothing else: uniform sky and flat ground know no north.
TEST(Invariant, TurningTheSceneChangesNothing) {
  Forest forest = mixed_tree();
  ReferenceOptions o;
  o.rays_per_face = 256;
  o.sun_rays_per_element = 256;
  const LightMap here =
      trace_light(forest, 0.3, sunlight(direction_from_azimuth_zenith(1.0, 0.6), 400, 100), o);
  forest.instances[0].yaw_rad = 0.9f;  // counter-clockwise, azimuth runs clockwise
  const LightMap there =
      trace_light(forest, 0.3, sunlight(direction_from_azimuth_zenith(0.1, 0.6), 400, 100), o);
  double squares = 0.0;
  const auto n = here.bands[0].elements.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double error =
        std::hypot(here.bands[0].standard_error_w_m2[i], there.bands[0].standard_error_w_m2[i]);
    squares += std::pow((total(here.bands[0].elements[i]) - total(there.bands[0].elements[i])) / error, 2);
  }
  EXPECT_LT(squares / static_cast<double>(n), 1.4);  // 240 elements: 1 +- 0.09 if independent
}

TEST(Invariant, WoodShadowOfACylinder) {
  // A wide leaf under a horizontal log of diameter 0.4 across all of it: the sun overhead misses 0.4 / 2.
  Forest forest = forest_of({quad({0, 0, 1}, {1, 0, 0}, {0, 0.5, 0})});
  forest.prototypes[0].wood.push_back({{0, -3, 2}, {0, 3, 2}, 0.2f, 0.2f, 0});
  ReferenceOptions o;
  o.sun_rays_per_element = 20000;
  const LightMap map = trace_light(forest, 0.0, sunlight({0, 0, 1}, 1000.0), o);
  EXPECT_NEAR(map.sunlit_fraction[0], 0.8, 4 * std::sqrt(0.8 * 0.2 / 20000));
  // The log itself absorbs what falls on its shadow's area: 0.4 * 6.
  EXPECT_NEAR(map.bands[0].budget.absorbed_wood_w, 1000.0 * 0.4 * 6, 0.02 * 2400);
  expect_sound(map, forest);
}

// Needles of a lone thin shoot: the beam meets a quarter of it on each face, the sky of one half a half.
TEST(Invariant, LoneShoot) {
  const Forest forest = forest_of({shoot({0, 0, 1}, {0.1, 0, 0}, 0.05, 1e-6)});
  ReferenceOptions o;
  o.rays_per_face = 20000;
  o.ground = false;
  const LightMap map = trace_light(forest, 0.0, sunlight({0.2, 0.1, 1}, 100.0, 100.0), o);
  for (const FaceLight& f : {map.bands[0].elements[0].front, map.bands[0].elements[0].back}) {
    EXPECT_NEAR(f.direct_w_m2, 25.0, 1e-3);
    EXPECT_NEAR(f.sky_w_m2, 50.0, 4 * 50.0 / std::sqrt(20000.0));
  }
}

struct Extreme {
  const char* what;
  Forest forest;
  Illumination light;
  double soil;
};

std::vector<Extreme> extremes() {
  const auto leaf = quad({0, 0, 1}, {0.1, 0, 0}, {0, 0.1, 0});
  const auto upright = quad({0, 0, 1}, {0.1, 0, 0}, {0, 0, 0.1});
  const Illumination day = sunlight({1, 0, 2}, 400, 100);
  std::vector<Extreme> all = {
      {"one leaf", forest_of({leaf}, {Leaf{0.3, 0.3}}), day, 0.2},
      {"two leaves in one place", forest_of({leaf, leaf}, {Leaf{0.3, 0.3}}), skylight(100), 0.2},
      {"edge-on to the sun", forest_of({upright}, {Leaf{0.3, 0.3}}), sunlight({0, 0, 1}, 400, 100), 0.2},
      {"a leaf of no area", forest_of({quad({0, 0, 1}, {0, 0, 0}, {0, 0, 0}), leaf}), day, 0.2},
      {"sun a hair above the horizon", forest_of({leaf, upright}), sunlight({1, 0, 1e-9}, 400, 100), 0.2},
      {"sun a hair below the horizon", forest_of({leaf, upright}), sunlight({1, 0, -1e-9}, 400, 100), 0.2},
      {"no light", forest_of({leaf}, {Leaf{0.5, 0.5}}), skylight(0.0), 0.2},
      {"leaf on the ground", forest_of({quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}), day, 0.2},
      {"leaf in the ground", forest_of({quad({0, 0, -0.1}, {1, 0, 0}, {0, 1, 0}), leaf}), day, 0.2}};
  for (const double size : {1e-3, 1e3})
    for (const double albedo : {0.0, 1.0})
      all.push_back(
          {"size and albedo",
           forest_of(random_leaves(Crown::kSphere, Vec3(0, 0, 20 * size), Vec3(10 * size), 200, size, 3),
                     {Leaf{0.5 * albedo, 0.5 * albedo}}),
           day, albedo});
  for (std::size_t i = 0, n = all.size(); i < n; ++i) {
    Extreme periodic = all[i];
    const Box box = forest_bounds(periodic.forest);
    const double size = std::max({box.size().x, box.size().y, 0.1});
    // Crowns reach into each other's cells; a single leaf must not lie on its own copy.
    const double cell = (periodic.forest.prototypes[0].foliage.size() > 2 ? 0.8 : 1.3) * size;
    periodic.forest.period = Period{Vec2(box.centre()) - Vec2(0.5 * cell), Vec2(cell)};
    all.push_back(periodic);
  }
  return all;
}

TEST(Stress, ExtremesStaySound) {
  for (const Extreme& e : extremes()) {
    SCOPED_TRACE(std::string(e.what) + (e.forest.period ? ", periodic" : ""));
    const LightMap map = trace_light(e.forest, e.soil, e.light, {});
    EXPECT_EQ(find_violation(map, ForestIndex(e.forest)), "");
    // Two leaves in one place do not shade each other: their light is counted twice, and the residual says
    // so.
    if (std::string(e.what) != "two leaves in one place") expect_sound(map, e.forest);
  }
}

// Energy closes on slopes and without ground, alone and in a period, under sun and sky.
TEST(Stress, SlopesAndNoGroundStaySound) {
  for (const bool ground : {true, false})
    for (const double slope_deg : {0.0, 35.0})
      for (const bool periodic : {false, true}) {
        SCOPED_TRACE(std::to_string(ground) + std::to_string(slope_deg) + std::to_string(periodic));
        Forest forest = mixed_tree();
        forest.terrain = {0.3, radians_from_degrees(slope_deg), 1.0};
        forest.instances[0].position_m.z = 0.3;
        if (periodic) forest.period = Period{{-0.8, -0.8}, {1.7, 1.6}};
        ReferenceOptions o;
        o.ground = ground;
        const LightMap map = trace_light(forest, 0.3, sunlight({0.3, 1, 2}, 400, 100), o);
        expect_sound(map, forest);
        EXPECT_LT(map.bands[0].budget.residual_standard_error_w, 0.03 * map.bands[0].budget.incident_w);
      }
}

// A leaf may cover another at a distance of next to nothing: the upper one takes the light, whatever the
// size.
TEST(Stress, SheetsOnTopOfEachOther) {
  for (const double size : {1e-3, 1.0, 1e3}) {
    const Forest forest = forest_of({quad({0, 0, 2 * size}, {size, 0, 0}, {0, size, 0}),
                                     quad({0, 0, (2 + 1e-5) * size}, {size, 0, 0}, {0, size, 0})});
    const LightMap map = trace_light(forest, 0.0, sunlight({0.1, 0, 1}, 100.0), {});
    EXPECT_LT(map.sunlit_fraction[0], 0.02) << size;
    EXPECT_EQ(map.sunlit_fraction[1], 1.0f) << size;
  }
}

TEST(Stress, EdgeOnLeafGetsNoBeam) {
  const Forest forest = forest_of({quad({0, 0, 1}, {0.1, 0, 0}, {0, 0, 0.1})});
  const LightMap map = trace_light(forest, 0.0, sunlight({0, 0, 1}, 1000.0), {});
  EXPECT_EQ(map.bands[0].elements[0].front.direct_w_m2, 0.0f);
  EXPECT_EQ(map.bands[0].elements[0].back.direct_w_m2, 0.0f);
}

// A disc of the sun twice as wide as the gap's shadow half: a leaf behind a screen edge lies in half shade.
TEST(Invariant, SunDiscMakesPenumbra) {
  const Forest forest = forest_of({quad({0, 0, 1}, {1e-4, 0, 0}, {0, 1e-4, 0}),
                                   quad({-5, 0, 3}, {5, 0, 0}, {0, 5, 0})});  // edge straight above the leaf
  Illumination light = sunlight({0, 0, 1}, 1000.0);
  light.sun_half_angle_rad = radians_from_degrees(0.265);
  ReferenceOptions o;
  o.sun_rays_per_element = 20000;
  const LightMap map = trace_light(forest, 0.0, light, o);
  EXPECT_NEAR(map.sunlit_fraction[0], 0.5, 4 * 0.5 / std::sqrt(20000.0) + 0.01);
  EXPECT_NEAR(map.bands[0].elements[1].front.direct_w_m2, 1000.0, 1e-2);
}

// Twigs of a millimetre, far from the origin of their tree: rays from their inner side must not meet the
// outer one, and what they take must be missing elsewhere. A cell of one metre, so that every ray crosses
// many of them.
TEST(Closure, HoldsForThinTwigsHighUp) {
  for (const double height_m : {1.0, 20.0}) {
    Forest forest = forest_of({}, {Leaf{0.45, 0.45, 0.9}});
    Prototype& tree = forest.prototypes[0];
    RandomStream random(5, 0, RandomPurpose::kTestScene);
    const auto coordinate = [&] { return random.uniform(0.0, 1.0); };
    for (int i = 0; i < 600; ++i) {
      const Vec3 from(coordinate(), coordinate(), height_m + coordinate());
      const Vec3 way = glm::normalize(Vec3(coordinate(), coordinate(), coordinate()) - 0.5);
      tree.wood.push_back({Vec3f(from), Vec3f(from + 0.4 * way), 0.001f, 0.001f, 0});
    }
    tree.foliage.push_back(disc(Vec3(0.5, 0.5, height_m), {0, 0, 1}, 0.05));
    forest.period = Period{{0, 0}, {1, 1}};
    ReferenceOptions options;
    options.rays_per_face = options.sun_rays_per_element = 256;
    const LightMap map = trace_light(forest, 0.3, sunlight({0.3, 0.2, 1}, 100, 100), options);
    expect_sound(map, forest);
    EXPECT_GT(map.bands[0].budget.absorbed_wood_w, 10.0);
  }
}

}  // namespace
}  // namespace sunfleck::test
