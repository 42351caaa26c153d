#include "sim/plant/element_faces.h"

#include <cmath>

#include "sim/base/contract.h"

namespace sunfleck {
namespace {

constexpr int kSides = 8;

Vec3 on_circle(const Basis& basis, int corner) {
  const double angle_rad = 2.0 * kPi * corner / kSides;
  return std::cos(angle_rad) * basis.tangent + std::sin(angle_rad) * basis.bitangent;
}

std::vector<Vec3> octagon(const Vec3& centre, const Vec3& u, const Vec3& v) {
  // Area of a regular polygon of n corners at distance R: n/2 R^2 sin(2 pi/n).
  const double reach = std::sqrt(2.0 * kPi / (kSides * std::sin(2.0 * kPi / kSides)));
  std::vector<Vec3> corners;
  for (int i = 0; i < kSides; ++i) {
    const double angle_rad = 2.0 * kPi * i / kSides;
    corners.push_back(centre + reach * (std::cos(angle_rad) * u + std::sin(angle_rad) * v));
  }
  return corners;
}

}  // namespace

std::vector<Vec3> leaf_corners(const FoliageElement& element) {
  SUNFLECK_EXPECTS(element.shape != ElementShape::kShoot);
  const Vec3 c(element.centre_m), u(element.half_u_m), v(element.half_v_m);
  if (element.shape == ElementShape::kParallelogram) return {c - u - v, c + u - v, c + u + v, c - u + v};
  if (element.shape == ElementShape::kDisc) return octagon(c, u, v);
  const Vec3 corner = c - (u + v) / 3.0;
  return {corner, corner + u, corner + v};
}

std::vector<std::array<Vec3, 4>> prism_sides(const Vec3& from_m, const Vec3& to_m, double radius_from_m,
                                             double radius_to_m) {
  std::vector<std::array<Vec3, 4>> sides;
  const double length_m = glm::distance(from_m, to_m);
  if (!(length_m > 0.0)) return sides;
  const Basis basis = basis_around((to_m - from_m) / length_m);
  for (int i = 0; i < kSides; ++i) {
    const Vec3 a = on_circle(basis, i), b = on_circle(basis, (i + 1) % kSides);
    sides.push_back({from_m + radius_from_m * a, from_m + radius_from_m * b, to_m + radius_to_m * b,
                     to_m + radius_to_m * a});
  }
  return sides;
}

}  // namespace sunfleck
