#include "lighting/trace/open_plane.h"

#include <algorithm>
#include <cmath>

namespace sunfleck::trace {
namespace {

// Irradiance by a sky of diffuse irradiance 1: midpoint rule in cos zenith and azimuth, good to 1e-6.
double sky_part(const SkyRadiance& sky, const Vec3& normal) {
  if (normal.z > 1.0 - 1e-15) return 1.0;
  if (normal.z < -1.0 + 1e-15) return 0.0;
  constexpr int kRings = 512, kSectors = 1024;
  double sum = 0.0;
  for (int i = 0; i < kRings; ++i) {
    const double z = (i + 0.5) / kRings, across = std::sqrt(1.0 - z * z);
    double ring = 0.0;
    for (int j = 0; j < kSectors; ++j) {
      const double turn = 2.0 * kPi * (j + 0.5) / kSectors;
      const Vec3 v(across * std::cos(turn), across * std::sin(turn), z);
      const double cosine = std::max(0.0, glm::dot(normal, v));
      ring += sky.is_round() ? cosine : cosine * sky.radiance(v);
    }
    sum += sky.is_round() ? sky.ring_mean(z) * ring : ring;
  }
  return sum * 2.0 * kPi / (kRings * kSectors);
}

}  // namespace

double open_irradiance_w_m2(const Illumination& light, const BandLight& band, const Vec3& normal) {
  const double beam =
      light.sun_is_up() ? band.beam_normal_w_m2 * std::max(0.0, glm::dot(normal, light.to_sun)) : 0.0;
  return beam + band.diffuse_horizontal_w_m2 * sky_part(sky_radiance(light), normal);
}

}  // namespace sunfleck::trace
