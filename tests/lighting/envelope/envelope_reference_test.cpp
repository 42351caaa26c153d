// The envelope estimator against traced light, crown means. Soil is black. Tolerances are what the method
// reaches on these crowns plus three standard errors of the reference, which is stated with every comparison;
// seeds are fixed.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "lighting/trace/reference.h"
#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"
#include "tests/lighting/envelope/scenes.h"

namespace sunfleck {
namespace {

using test::envelope_map;
using test::light_of;
using test::optics_of;

LightMap traced(const Forest& forest, const OpticsTable& optics, const Illumination& light) {
  ReferenceOptions options;
  options.rays_per_face = 32;
  options.sun_rays_per_element = 16;
  return reference_light_map(forest, optics, light, options, {});
}

double relative_error(const LightMap& map) {
  return map.bands[0].mean_irradiance_standard_error_w_m2 / map.bands[0].mean_irradiance_w_m2;
}

void expect_bias_below(const char* what, double estimate, double truth, double tolerance, double error) {
  const double bias = estimate / truth - 1;
  std::cout << what << ": bias " << 100 * bias << " % (reference +-" << 100 * error << " %)\n";
  EXPECT_LT(std::abs(bias), tolerance + 3 * error) << what;
}

// Leaves that scatter 4 %: what the second bounce adds stays below 4 % of the first.
OpticsTable dark_leaves(const Forest& forest) {
  const LeafOptics leaf{.reflectance_front = 0.03,
                        .reflectance_back = 0.03,
                        .transmittance_front = 0.01,
                        .transmittance_back = 0.01};
  return OpticsTable(forest,
                     {.bands = {"VIS"}, .soil_albedo = {0.0}, .overrides = {{"*", "VIS", {leaf, 0.0}}}});
}

const Vec3 kSun = glm::normalize(Vec3(0.45, 0.25, 0.86));

struct Tolerances {
  CrownKind kind;
  const char* name;
  double lai, sun, sky, bounce;
};
// Clumps of 0.12 radii hold some 300 leaves of half a cell each: shade inside them is smeared.
const Tolerances kCrowns[] = {{CrownKind::kSphere, "sphere LAI 2", 2, 0.02, 0.03, 0.06},
                              {CrownKind::kSphere, "sphere LAI 5", 5, 0.03, 0.06, 0.10},
                              {CrownKind::kCone, "cone LAI 5", 5, 0.04, 0.06, 0.10},
                              {CrownKind::kShell, "shell LAI 5", 5, 0.04, 0.06, 0.10},
                              {CrownKind::kClumped, "clumped LAI 5", 5, 0.06, 0.08, 0.20}};

TEST(AgainstRays, MarchedSunSkyAndOneBounce) {
  for (const Tolerances& crown : kCrowns) {
    const Forest forest =
        generated_crown({.kind = crown.kind, .leaves = 10000, .crown_lai = crown.lai, .seed = 5});
    const OpticsTable optics = dark_leaves(forest);
    const Illumination sun = light_of(kSun, 1000, 0), sky = light_of(kSun, 0, 1000);
    const LightMap traced_sun = traced(forest, optics, sun), traced_sky = traced(forest, optics, sky);
    const LightMap own_sun = envelope_map(forest, optics, sun), own_sky = envelope_map(forest, optics, sky);
    const std::string name = crown.name;
    expect_bias_below((name + " sun").c_str(), test::mean_direct(own_sun), test::mean_direct(traced_sun),
                      crown.sun, relative_error(traced_sun));
    expect_bias_below((name + " sky").c_str(), test::mean_sky(own_sky), test::mean_sky(traced_sky), crown.sky,
                      relative_error(traced_sky));
    expect_bias_below((name + " one bounce").c_str(), test::mean_scattered(own_sun),
                      test::mean_scattered(traced_sun), crown.bounce, relative_error(traced_sun));
  }
}

// A ball of shoots: cylinders of needles that shade each other, and the needles inside them.
Forest ball_of_shoots(int count, double needles_m2) {
  Forest forest = generated_crown({.leaves = count, .crown_lai = 3, .seed = 9});
  for (FoliageElement& e : forest.prototypes[0].foliage) {
    e.shape = ElementShape::kShoot;
    e.half_u_m = glm::normalize(e.half_u_m) * 0.03f;
    e.half_v_m = glm::normalize(e.half_v_m) * 0.01f;
    e.area_m2 = static_cast<float>(needles_m2);
  }
  return forest;
}

TEST(AgainstRays, Shoots) {
  // Thin shoots (needle depth 0.1 across) and dense ones (1.3), about one half of the ball's silhouette each.
  for (const double needles_m2 : {2e-4, 2.5e-3}) {
    const Forest forest = ball_of_shoots(4000, needles_m2);
    const OpticsTable optics = dark_leaves(forest);
    const Illumination sun = light_of(kSun, 1000, 0), sky = light_of(kSun, 0, 1000);
    const LightMap traced_sun = traced(forest, optics, sun), traced_sky = traced(forest, optics, sky);
    expect_bias_below("shoots, sun", test::mean_direct(envelope_map(forest, optics, sun)),
                      test::mean_direct(traced_sun), 0.05, relative_error(traced_sun));
    expect_bias_below("shoots, sky", test::mean_sky(envelope_map(forest, optics, sky)),
                      test::mean_sky(traced_sky), 0.08, relative_error(traced_sky));
  }
}

TEST(AgainstRays, WoodShades) {
  // Thirty level branches of 8 cm through the middle of a ball.
  Forest forest = generated_crown({.leaves = 10000, .crown_lai = 2, .seed = 5});
  for (int i = 0; i < 30; ++i) {
    const double turn = i * 2.4, height = 0.9 + 1.2 * i / 29.0;
    const Vec3f tip(0.8 * std::cos(turn), 0.8 * std::sin(turn), height);
    forest.prototypes[0].wood.push_back({.from_m = {0, 0, static_cast<float>(height)},
                                         .to_m = tip,
                                         .radius_from_m = 0.04f,
                                         .radius_to_m = 0.04f});
  }
  const OpticsTable optics = dark_leaves(forest);
  const Illumination sun = light_of(kSun, 1000, 0);
  const LightMap reference = traced(forest, optics, sun);
  const double bare = sunfleck::test::mean_direct(
      envelope_map(generated_crown({.leaves = 10000, .crown_lai = 2, .seed = 5}), optics, sun));
  const double own = test::mean_direct(envelope_map(forest, optics, sun));
  EXPECT_LT(own, 0.97 * bare);
  expect_bias_below("crown with branches, sun", own, test::mean_direct(reference), 0.06,
                    relative_error(reference));
}

TEST(AgainstRays, RepeatingLayerWithShadeOnASlope) {
  Forest forest = generated_layer({.lai = 2, .leaves = 4000, .seed = 3});
  forest.terrain = {.elevation_m = 0, .slope_rad = 0.35, .aspect_rad = 2.0};
  for (FoliageElement& e : forest.prototypes[0].foliage)
    e.centre_m.z += static_cast<float>(forest.terrain.height_at(e.centre_m.x, e.centre_m.y));
  const OpticsTable optics = dark_leaves(forest);
  for (const Vec3& to_sun :
       {Vec3(0, 0, 1), glm::normalize(Vec3(0.6, -0.5, 0.9)), glm::normalize(Vec3(-0.9, 0.3, 1.0))}) {
    const Illumination sun = light_of(to_sun, 1000, 0);
    const LightMap reference = traced(forest, optics, sun);
    expect_bias_below("slope, sun", test::mean_direct(envelope_map(forest, optics, sun)),
                      test::mean_direct(reference), 0.03, relative_error(reference));
  }
}

}  // namespace
}  // namespace sunfleck
