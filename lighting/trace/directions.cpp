#include "lighting/trace/directions.h"

#include <algorithm>
#include <cmath>

namespace sunfleck::trace {
namespace {

Vec3 around(const Vec3& axis, double along, double across, double turn) {
  const Basis basis = basis_around(axis);
  return across * (std::cos(turn) * basis.tangent + std::sin(turn) * basis.bitangent) + along * axis;
}

}  // namespace

Vec3 cosine_direction(const Vec3& normal, RandomStream& random) {
  const double x = random.uniform(), y = random.uniform();
  return cosine_direction(normal, x, y);
}

Vec3 cosine_direction(const Vec3& normal, double a, double b) {
  const Vec2 p = on_disc(a, b);
  const Basis basis = basis_around(normal);
  const double up = std::sqrt(std::max(1e-16, 1.0 - p.x * p.x - p.y * p.y));
  return glm::normalize(p.x * basis.tangent + p.y * basis.bitangent + up * normal);
}

Vec3 cone_direction(const Vec3& axis, double half_angle_rad, RandomStream& random) {
  if (half_angle_rad == 0.0) return axis;
  const double x = random.uniform(), y = random.uniform();
  return cone_direction(axis, half_angle_rad, x, y);
}

Vec3 cone_direction(const Vec3& axis, double half_angle_rad, double a, double b) {
  if (half_angle_rad == 0.0) return axis;
  const double drop = a * 2.0 * std::pow(std::sin(0.5 * half_angle_rad), 2);  // 1 - cos
  return glm::normalize(around(axis, 1.0 - drop, std::sqrt(drop * (2.0 - drop)), 2.0 * kPi * b));
}

Vec3 any_direction(RandomStream& random) {
  const double a = random.uniform(), b = random.uniform();
  return any_direction(a, b);
}

Vec3 any_direction(double a, double b) {
  const double z = 2.0 * a - 1.0, turn = 2.0 * kPi * b;
  const double across = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {across * std::cos(turn), across * std::sin(turn), z};
}

Vec2 on_disc(double a, double b) {
  const double x = 2.0 * a - 1.0, y = 2.0 * b - 1.0;
  if (x == 0.0 && y == 0.0) return {0.0, 0.0};
  const bool wide = std::abs(x) > std::abs(y);
  const double radius = wide ? x : y, turn = wide ? 0.25 * kPi * (y / x) : 0.5 * kPi - 0.25 * kPi * (x / y);
  return {radius * std::cos(turn), radius * std::sin(turn)};
}

}  // namespace sunfleck::trace
