#include "lighting/shade/shoot_bough.h"

#include <algorithm>
#include <cmath>

#include "sim/base/contract.h"

namespace sunfleck {
namespace {

constexpr double kTwigShare = 0.08;  // of needles.cpp: needles begin at this share of the radius

}  // namespace

ShootBough shoot_bough(const FoliageElement& shoot, const FoliageTemplate& foliage, double hot_spot_radii) {
  SUNFLECK_EXPECTS(shoot.shape == ElementShape::kShoot);
  const Vec3 u(shoot.half_u_m);
  const double length = 2.0 * glm::length(u), radius = glm::length(Vec3(shoot.half_v_m));
  ShootBough b;
  b.origin_m = Vec3(shoot.centre_m) - u;
  if (!(length > 0.0 && radius > 0.0)) return b;
  const Basis basis = basis_around(u / (0.5 * length));
  b.axis = u / (0.5 * length), b.side = basis.tangent, b.up = glm::cross(b.axis, b.side);
  const double needle = std::min(foliage.needle_length_m * length / foliage.shoot_length_m, 0.9 * length);
  const double out = std::min((1 - kTwigShare) * radius, 0.98 * needle);
  const double forward = std::sqrt(needle * needle - out * out);
  const double longer = 1.0 + kTwigShare * radius / out;  // from the axis on
  BoughVolume& v = b.volume;
  v.sin_aperture = out / needle;
  v.cos_aperture = forward / needle;
  const double needle_radius = shoot.area_m2 / (kPi * needle * static_cast<double>(needle_count(foliage)));
  v.outer_radius = longer * out + needle_radius;
  v.hot_spot_length = hot_spot_radii * needle_radius;
  b.origin_m -= kTwigShare * radius * forward / out * b.axis;
  v.lowest = 0.0;
  v.highest = length - forward;
  // N r / (pi spacing sin(aperture)), with N needles of n radius over highest - lowest in all.
  v.density = shoot.area_m2 / (kPi * needle * longer) / (kPi * v.highest * v.sin_aperture);
  return b;
}

}  // namespace sunfleck
