#include "sim/plant/leaf_angle_sampling.h"

#include <cmath>

namespace sunfleck {
namespace {

// Rejection under a constant; the densities reach at most 4/pi, so half of the draws or more are kept.
double sample_inclination_rad(LeafAngles angles, RandomStream& random) {
  if (angles == LeafAngles::kSpherical) return std::acos(random.uniform());
  for (;;) {
    const double inclination_rad = random.uniform(0.0, 0.5 * kPi);
    if (random.uniform(0.0, 4.0 / kPi) < leaf_inclination_density(angles, inclination_rad))
      return inclination_rad;
  }
}

}  // namespace

double leaf_inclination_density(LeafAngles angles, double inclination_rad) {
  const double t = inclination_rad;
  switch (angles) {
    case LeafAngles::kSpherical:
      return std::sin(t);
    case LeafAngles::kPlanophile:
      return 2.0 / kPi * (1.0 + std::cos(2.0 * t));
    case LeafAngles::kErectophile:
      return 2.0 / kPi * (1.0 - std::cos(2.0 * t));
    case LeafAngles::kPlagiophile:
      return 2.0 / kPi * (1.0 - std::cos(4.0 * t));
    case LeafAngles::kUniform:
      break;
  }
  return 2.0 / kPi;
}

Vec3 sample_leaf_normal(LeafAngles angles, RandomStream& random) {
  const double inclination_rad = sample_inclination_rad(angles, random);
  return direction_from_azimuth_zenith(random.uniform(0.0, 2.0 * kPi), inclination_rad);
}

}  // namespace sunfleck
