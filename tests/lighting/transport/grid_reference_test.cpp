// The grid method against traced light, per leaf and on average. Three bands in one run: sun alone and sky
// alone with near-infrared leaves (r = t = 0.45), sky alone with visible ones (0.25). Errors are of diffuse
// light (sky and scattered), front + back; the reference's own scatter (64 rays per face: 5 % per leaf in
// near-infrared, 11 % visible) is inside the per-leaf figures. Seeds are fixed.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "sim/forest/generated_scenes.h"
#include "tests/lighting/transport/grid_light.h"

namespace sunfleck::test {
namespace {

const Vec3 kSun = glm::normalize(Vec3(0.45, 0.25, 0.86));

struct Case {
  Forest forest;
  OpticsTable optics;
  Illumination light;
};

Case case_of(Forest forest, double soil_albedo) {
  for (Material& material : forest.materials)
    material.bands = {
        {"sun NIR", 0.45, 0.45, 0.3}, {"sky NIR", 0.45, 0.45, 0.3}, {"sky VIS", 0.25, 0.25, 0.1}};
  OpticsTable optics = band_optics(forest, {"sun NIR", "sky NIR", "sky VIS"}, soil_albedo);
  Illumination light;
  light.to_sun = kSun;
  light.bands = {{1000, 0}, {0, 1000}, {0, 1000}};
  return {std::move(forest), std::move(optics), std::move(light)};
}

LightMap traced(const Case& c) {
  ReferenceOptions options;
  options.rays_per_face = 64;
  options.sun_rays_per_element = 32;
  return reference_light_map(c.forest, c.optics, c.light, options, {});
}

LightMap estimated(const Case& c, int directions = 26) {
  return grid_light_map(c.forest, c.optics, c.light, {.directions = directions}, {});
}

struct Errors {
  double bias = 0, mean_absolute = 0;
};

double diffuse(const ElementLight& e) {
  return static_cast<double>(e.front.sky_w_m2) + e.front.scattered_w_m2 + e.back.sky_w_m2 +
         e.back.scattered_w_m2;
}

Errors errors(const BandLightMap& own, const BandLightMap& truth) {
  double sum = 0.0, true_sum = 0.0, off = 0.0;
  for (std::size_t i = 0; i < own.elements.size(); ++i) {
    sum += diffuse(own.elements[i]);
    true_sum += diffuse(truth.elements[i]);
    off += std::abs(diffuse(own.elements[i]) - diffuse(truth.elements[i]));
  }
  return {sum / true_sum - 1, off / true_sum};
}

struct Limits {
  double bias;
  std::array<double, 3> mean_absolute;  // per band
};

void expect_close(const char* scene, const LightMap& own, const LightMap& truth, const Limits& limits) {
  for (std::size_t b = 0; b < own.bands.size(); ++b) {
    const Errors e = errors(own.bands[b], truth.bands[b]);
    std::cout << scene << ", " << own.bands[b].band << ": bias " << 100 * e.bias << " %, per leaf "
              << 100 * e.mean_absolute << " %\n";
    EXPECT_LT(std::abs(e.bias), limits.bias) << scene << ' ' << own.bands[b].band;
    EXPECT_LT(e.mean_absolute, limits.mean_absolute[b]) << scene << ' ' << own.bands[b].band;
  }
}

TEST(AgainstRays, CrownsOfFortyThousandLeaves) {
  for (const auto& [kind, name] :
       {std::pair{CrownKind::kSphere, "sphere"}, std::pair{CrownKind::kCone, "cone"},
        std::pair{CrownKind::kClumped, "clumped"}}) {
    const Case c = case_of(generated_crown({.kind = kind, .leaves = 40000, .crown_lai = 5, .seed = 5}), 0.1);
    const LightMap truth = traced(c);
    expect_close((std::string(name) + ", 26 directions").c_str(), estimated(c), truth,
                 {0.025, {0.12, 0.08, 0.17}});
    expect_close((std::string(name) + ", 14 directions").c_str(), estimated(c, 14), truth,
                 {0.03, {0.12, 0.09, 0.18}});
    expect_close((std::string(name) + ", 8 directions").c_str(), estimated(c, 8), truth,
                 {0.04, {0.15, 0.11, 0.22}});
  }
}

TEST(AgainstRays, EndlessLayer) {
  const Case c = case_of(generated_layer({.lai = 3, .leaves = 10000}), 0.2);
  const LightMap truth = traced(c);
  expect_close("layer, 26 directions", estimated(c), truth, {0.025, {0.08, 0.06, 0.12}});
  expect_close("layer, 16 directions", estimated(c, 14), truth, {0.025, {0.08, 0.06, 0.12}});
  // Eight directions are one ring per hemisphere: too few for light through a layer.
  expect_close("layer, 8 directions", estimated(c, 8), truth, {0.10, {0.13, 0.08, 0.16}});
  for (const BandLightMap& band : estimated(c).bands)
    EXPECT_LT(std::abs(band.budget.residual_w), 0.02 * band.budget.incident_w) << band.band;
}

TEST(AgainstRays, EndlessLayerOnASlope) {
  Forest forest = generated_layer({.lai = 2, .leaves = 6000, .seed = 3});
  forest.terrain = {.elevation_m = 0, .slope_rad = 0.35, .aspect_rad = 2.0};
  for (FoliageElement& e : forest.prototypes[0].foliage)
    e.centre_m.z += static_cast<float>(forest.terrain.height_at(e.centre_m.x, e.centre_m.y));
  const Case c = case_of(std::move(forest), 0.2);
  expect_close("layer on a slope", estimated(c), traced(c), {0.03, {0.10, 0.07, 0.14}});
}

TEST(AgainstRays, CrownOnASlope) {
  Forest forest = generated_crown({.leaves = 10000, .crown_lai = 4, .seed = 2});
  forest.terrain = {.elevation_m = 0, .slope_rad = 0.4, .aspect_rad = 1.0};
  const Case c = case_of(std::move(forest), 0.3);
  expect_close("crown on a slope", estimated(c), traced(c), {0.04, {0.12, 0.08, 0.17}});
}

TEST(AgainstRays, FlatLeaves) {
  // Planophile: normals within 40 degrees of the vertical.
  Forest forest = generated_crown({.kind = CrownKind::kCone, .leaves = 10000, .crown_lai = 4, .seed = 7});
  for (FoliageElement& e : forest.prototypes[0].foliage) {
    Vec3 normal(element_normal(e));
    normal.z = std::abs(normal.z) + 1.5;
    const Basis basis = basis_around(glm::normalize(normal));
    const double half = 0.5 * std::sqrt(static_cast<double>(e.area_m2));
    e.half_u_m = Vec3f(half * basis.tangent);
    e.half_v_m = Vec3f(half * basis.bitangent);
  }
  const Case c = case_of(std::move(forest), 0.1);
  expect_close("planophile cone", estimated(c), traced(c), {0.04, {0.12, 0.08, 0.17}});
}

TEST(AgainstRays, Shoots) {
  // Thin shoots (needle depth 0.1 across) and dense ones (1.3).
  for (const double needles_m2 : {2e-4, 2.5e-3}) {
    Forest forest = generated_crown({.leaves = 4000, .crown_lai = 3, .seed = 9});
    for (FoliageElement& e : forest.prototypes[0].foliage) {
      e.shape = ElementShape::kShoot;
      e.half_u_m = glm::normalize(e.half_u_m) * 0.03f;
      e.half_v_m = glm::normalize(e.half_v_m) * 0.01f;
      e.area_m2 = static_cast<float>(needles_m2);
    }
    const Case c = case_of(std::move(forest), 0.1);
    expect_close("shoots", estimated(c), traced(c), {0.06, {0.15, 0.12, 0.18}});
  }
}

TEST(AgainstRays, CrownWithBranches) {
  // Thirty level branches of 8 cm through the middle of a ball.
  Forest forest = generated_crown({.leaves = 10000, .crown_lai = 2, .seed = 5});
  for (int i = 0; i < 30; ++i) {
    const double turn = i * 2.4, height = 0.9 + 1.2 * i / 29.0;
    forest.prototypes[0].wood.push_back({.from_m = {0, 0, static_cast<float>(height)},
                                         .to_m = Vec3f(0.8 * std::cos(turn), 0.8 * std::sin(turn), height),
                                         .radius_from_m = 0.04f,
                                         .radius_to_m = 0.04f});
  }
  const Case c = case_of(std::move(forest), 0.1);
  expect_close("crown with branches", estimated(c), traced(c), {0.05, {0.15, 0.09, 0.17}});
}

}  // namespace
}  // namespace sunfleck::test
