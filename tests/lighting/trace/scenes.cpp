#include "tests/lighting/trace/scenes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lighting/base/summaries.h"
#include "sim/base/random.h"

namespace sunfleck::test {
namespace {

FoliageElement with_area(FoliageElement e) {
  e.area_m2 = static_cast<float>(element_geometric_area(e));
  return e;
}

Vec3 random_normal(RandomStream& random) {
  const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * kPi), r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

}  // namespace

FoliageElement quad(const Vec3& centre, const Vec3& half_u, const Vec3& half_v, std::uint16_t material) {
  return with_area({.centre_m = centre,
                    .half_u_m = half_u,
                    .half_v_m = half_v,
                    .shape = ElementShape::kParallelogram,
                    .material = material});
}

FoliageElement triangle(const Vec3& a, const Vec3& b, const Vec3& c, std::uint16_t material) {
  return with_area({.centre_m = (a + b + c) / 3.0,
                    .half_u_m = b - a,
                    .half_v_m = c - a,
                    .shape = ElementShape::kTriangle,
                    .material = material});
}

FoliageElement disc(const Vec3& centre, const Vec3& normal, double radius, std::uint16_t material) {
  const Basis basis = basis_around(glm::normalize(normal));
  return with_area({.centre_m = centre,
                    .half_u_m = radius * basis.tangent,
                    .half_v_m = radius * basis.bitangent,
                    .shape = ElementShape::kDisc,
                    .material = material});
}

FoliageElement shoot(const Vec3& centre, const Vec3& half_axis, double radius, double area_m2) {
  return {.centre_m = centre,
          .half_u_m = half_axis,
          .half_v_m = radius * basis_around(glm::normalize(half_axis)).tangent,
          .area_m2 = static_cast<float>(area_m2),
          .shape = ElementShape::kShoot};
}

std::vector<FoliageElement> random_leaves(Crown shape, const Vec3& centre, const Vec3& half_size,
                                          std::size_t count, double side, std::uint64_t seed) {
  RandomStream random(seed, 0, RandomPurpose::kTestScene);
  std::vector<FoliageElement> leaves;
  while (leaves.size() < count) {
    const Vec3 p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (shape == Crown::kSphere && glm::dot(p, p) > 1.0) continue;
    const Vec3 n = random_normal(random);
    const Basis basis = basis_around(n);
    leaves.push_back(quad(centre + p * half_size, 0.5 * side * basis.tangent, 0.5 * side * basis.bitangent));
  }
  return leaves;
}

Forest forest_of(std::vector<FoliageElement> foliage, const std::vector<Leaf>& materials) {
  Forest forest;
  Prototype prototype;
  prototype.name = "plant";
  prototype.foliage = std::move(foliage);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const std::string name = "m" + std::to_string(i);
    forest.materials.push_back(
        {name, {{"B", materials[i].reflectance, materials[i].transmittance, materials[i].bark}}});
    prototype.materials.push_back(name);
  }
  forest.prototypes.push_back(std::move(prototype));
  forest.instances.push_back({});
  return forest;
}

OpticsTable optics_of(const Forest& forest, double soil_albedo) {
  return {forest, {.bands = {"B"}, .soil_albedo = {soil_albedo}, .overrides = {}}};
}

Illumination sunlight(const Vec3& to_sun, double beam_normal_w_m2, double diffuse_w_m2) {
  Illumination light;
  light.to_sun = glm::normalize(to_sun);
  light.bands = {{beam_normal_w_m2, diffuse_w_m2}};
  return light;
}

Illumination skylight(double diffuse_w_m2, SkyModel sky) {
  Illumination light = sunlight({0, 0, 1}, 0.0, diffuse_w_m2);
  light.sky = sky;
  return light;
}

LightMap trace_light(const Forest& forest, double soil_albedo, const Illumination& light,
                     const ReferenceOptions& options) {
  return reference_light_map(forest, optics_of(forest, soil_albedo), light, options, {});
}

void expect_sound(const LightMap& map, const Forest& forest, double convergence) {
  EXPECT_EQ(find_violation(map, ForestIndex(forest)), "");
  for (const BandLightMap& band : map.bands) {
    const EnergyBudget& b = band.budget;
    EXPECT_LE(std::abs(b.residual_w),
              4.0 * b.residual_standard_error_w + (1e-6 + convergence) * b.incident_w);
    EXPECT_NEAR(b.incident_w,
                b.absorbed_foliage_w + b.absorbed_wood_w + b.absorbed_ground_w + b.escaped_w + b.residual_w,
                1e-9 * b.incident_w);
  }
}

Moments moments(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  Moments m;
  for (const double v : values) m.mean += v / n;
  double squares = 0.0;
  for (const double v : values) squares += (v - m.mean) * (v - m.mean);
  m.standard_error = std::sqrt(squares / (n - 1.0) / n);
  return m;
}

}  // namespace sunfleck::test
