// Small scenes with known answers, and crowns of random leaves, for the tests of traced light.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lighting/trace/reference.h"

namespace sunfleck::test {

// A flat leaf centre +- u +- v; front normal along u x v.
FoliageElement quad(const Vec3& centre, const Vec3& half_u, const Vec3& half_v, std::uint16_t material = 0);
FoliageElement triangle(const Vec3& a, const Vec3& b, const Vec3& c, std::uint16_t material = 0);
FoliageElement disc(const Vec3& centre, const Vec3& normal, double radius, std::uint16_t material = 0);
FoliageElement shoot(const Vec3& centre, const Vec3& half_axis, double radius, double area_m2);

// Leaves of side `side` with normals turned any way.
enum class Crown { kSphere, kBox };
std::vector<FoliageElement> random_leaves(Crown shape, const Vec3& centre, const Vec3& half_size,
                                          std::size_t count, double side, std::uint64_t seed);

// One prototype standing once at the origin; `materials` named "m0", "m1" ... with one band "B" each.
struct Leaf {
  double reflectance = 0, transmittance = 0, bark = 0;
};
Forest forest_of(std::vector<FoliageElement> foliage, const std::vector<Leaf>& materials = {Leaf{}});

OpticsTable optics_of(const Forest& forest, double soil_albedo);

// One band "B" of sun and sky.
Illumination sunlight(const Vec3& to_sun, double beam_normal_w_m2, double diffuse_w_m2 = 0);
Illumination skylight(double diffuse_w_m2, SkyModel sky = SkyModel::kUniform);

LightMap trace_light(const Forest& forest, double soil_albedo, const Illumination& light,
                     const ReferenceOptions& options);

// Expects no violation and |residual| <= 4 standard errors (chance of a false alarm about 3e-3 with
// 8 groups) + rounding and convergence.
void expect_sound(const LightMap& map, const Forest& forest, double convergence = 1e-4);

struct Moments {
  double mean = 0, standard_error = 0;
};
// Of independent values (seeds).
Moments moments(const std::vector<double>& values);

}  // namespace sunfleck::test
