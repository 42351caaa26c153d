#include "sim/base/vec.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace sunfleck {

Vec3 direction_from_azimuth_zenith(double azimuth_rad, double zenith_rad) {
  const double s = std::sin(zenith_rad);
  return {s * std::sin(azimuth_rad), s * std::cos(azimuth_rad), std::cos(zenith_rad)};
}

double azimuth_of(const Vec3& direction) {
  const double azimuth = std::atan2(direction.x, direction.y);
  return azimuth < 0.0 ? azimuth + 2.0 * kPi : azimuth;
}

double zenith_of(const Vec3& direction) {
  return std::atan2(std::hypot(direction.x, direction.y), direction.z);
}

Basis basis_around(const Vec3& n) {
  const double sign = std::copysign(1.0, n.z);
  const double a = -1.0 / (sign + n.z);
  const double b = n.x * n.y * a;
  return {{1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}};
}

bool is_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void Box::include(const Vec3& p) {
  lo = glm::min(lo, p);
  hi = glm::max(hi, p);
}

void Box::include(const Box& other) {
  if (other.empty()) return;
  include(other.lo);
  include(other.hi);
}

}  // namespace sunfleck
