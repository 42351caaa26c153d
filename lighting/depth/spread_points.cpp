// See spread_points.h. Points are the middles of equal parts, two or more per cell and edge.
#include "lighting/depth/spread_points.h"

#include <algorithm>
#include <cmath>

namespace sunfleck {

namespace {

int points_along(double length_m, double cell_m) {
  return static_cast<int>(std::clamp(std::ceil(2.0 * length_m / cell_m), 1.0, double(kMostPointsPerEdge)));
}

// Middle of part i of n of [-1, 1].
double middle(int i, int n) { return (2 * i + 1) / static_cast<double>(n) - 1.0; }

void normalise_shares(std::vector<SpreadPoint>& points) {
  double sum = 0.0;
  for (const SpreadPoint& p : points) sum += p.share;
  for (SpreadPoint& p : points) p.share /= sum;
}

std::vector<SpreadPoint> spread_parallelogram(const WorldElement& e, double cell_m, bool disc) {
  const int nu = points_along(2.0 * glm::length(e.half_u_m), cell_m);
  const int nv = points_along(2.0 * glm::length(e.half_v_m), cell_m);
  std::vector<SpreadPoint> points;
  for (int i = 0; i < nu; ++i) {
    for (int j = 0; j < nv; ++j) {
      const double u = middle(i, nu), v = middle(j, nv);
      if (disc && u * u + v * v > 1.0) continue;
      points.push_back({e.centre_m + u * e.half_u_m + v * e.half_v_m, 1.0});
    }
  }
  normalise_shares(points);
  return points;
}

// Even points of a disc of `radius_m` across `axis`.
std::vector<Vec2> disc_points(double radius_m, double cell_m) {
  const int n = points_along(2.0 * radius_m, cell_m);
  std::vector<Vec2> points;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const Vec2 p(middle(i, n), middle(j, n));
      if (glm::dot(p, p) <= 1.0) points.push_back(radius_m * p);
    }
  }
  return points;
}

}  // namespace

bool needs_spreading(const WorldElement& element, double cell_m) {
  const double longest = 2.0 * std::max(glm::length(element.half_u_m), glm::length(element.half_v_m));
  if (longest > cell_m) return true;
  return element.shape != ElementShape::kShoot && element.area_m2 > 0.25 * cell_m * cell_m * (1.0 + 1e-6);
}

std::vector<SpreadPoint> spread_element(const WorldElement& e, double cell_m) {
  switch (e.shape) {
    case ElementShape::kParallelogram:
      return spread_parallelogram(e, cell_m, false);
    case ElementShape::kDisc:
      return spread_parallelogram(e, cell_m, true);
    case ElementShape::kTriangle: {
      const Vec3 corner = e.centre_m - (e.half_u_m + e.half_v_m) / 3.0;
      return spread_triangle(corner, corner + e.half_u_m, corner + e.half_v_m, cell_m);
    }
    case ElementShape::kShoot:
      break;
  }
  const double radius = glm::length(e.half_v_m);
  return spread_cylinder({e.centre_m - e.half_u_m, e.centre_m + e.half_u_m, radius, radius}, cell_m);
}

std::vector<SpreadPoint> spread_cylinder(const WorldCylinder& c, double cell_m) {
  const Vec3 axis = c.to_m - c.from_m;
  const double length = glm::length(axis);
  const Basis across = basis_around(length > 0.0 ? axis / length : Vec3(0, 0, 1));
  const int n = points_along(length, cell_m);
  std::vector<SpreadPoint> points;
  for (int i = 0; i < n; ++i) {
    const double t = 0.5 * (middle(i, n) + 1.0);
    const double radius = (1.0 - t) * c.radius_from_m + t * c.radius_to_m;
    const auto slice = disc_points(radius, cell_m);
    for (const Vec2& p : slice) {
      points.push_back({c.from_m + t * axis + p.x * across.tangent + p.y * across.bitangent,
                        std::max(radius, 1e-12) / static_cast<double>(slice.size())});
    }
  }
  normalise_shares(points);
  return points;
}

std::vector<SpreadPoint> spread_triangle(const Vec3& a, const Vec3& b, const Vec3& c, double cell_m) {
  const double longest = std::max({glm::length(b - a), glm::length(c - a), glm::length(c - b)});
  const int n = points_along(longest, cell_m);
  const Vec3 u = (b - a) / static_cast<double>(n), v = (c - a) / static_cast<double>(n);
  const double share = 1.0 / (static_cast<double>(n) * n);
  std::vector<SpreadPoint> points;
  // n^2 small triangles: those upright in the u, v lattice, and those upside down between them.
  for (int i = 0; i < n; ++i) {
    for (int j = 0; i + j < n; ++j) {
      const Vec3 corner = a + double(i) * u + double(j) * v;
      points.push_back({corner + (u + v) / 3.0, share});
      if (i + j + 1 < n) points.push_back({corner + 2.0 * (u + v) / 3.0, share});
    }
  }
  return points;
}

}  // namespace sunfleck
