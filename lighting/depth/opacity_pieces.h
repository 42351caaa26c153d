// Elements and wood cut into pieces no larger than a texel, each with the area it shows to the light.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "sim/base/vec.h"
#include "sim/plant/prototype.h"

namespace sunfleck {

// Mean |cos| between a direction and the normals of randomly turned needles.
inline constexpr double kRandomLeafProjection = 0.5;

// Area shown to the light, m2; needles of a shoot point everywhere alike.
inline double projected_area_m2(const FoliageElement& e, const Vec3& to_light) {
  if (e.shape == ElementShape::kShoot) return kRandomLeafProjection * e.area_m2;
  const Vec3 normal = glm::cross(Vec3(e.half_u_m), Vec3(e.half_v_m));
  const double length = glm::length(normal);
  return length > 0.0 ? e.area_m2 * std::abs(glm::dot(normal, to_light)) / length : 0.0;
}

inline int piece_count(double length_m, double texel_m) {
  return static_cast<int>(std::clamp(std::ceil(length_m / texel_m), 1.0, 64.0));
}

// Calls visit(centre, projected area in m2) for each piece of a foliage element. Discs and triangles are cut
// like the parallelogram around their middle: only elements larger than a texel notice.
template <class Visit>
void for_each_piece(const FoliageElement& e, const Vec3& to_light, double texel_m, const Visit& visit) {
  const double area = projected_area_m2(e, to_light);
  const Vec3 centre(e.centre_m);
  if (!(area > 0.0)) return;
  const double stretch = e.shape == ElementShape::kTriangle ? 0.5 : 1.0;
  const Vec3 u = stretch * Vec3(e.half_u_m), v = stretch * Vec3(e.half_v_m);
  const bool needles = e.shape == ElementShape::kShoot;
  const int nu = piece_count(2.0 * glm::length(u), texel_m);
  const int nv = needles ? 1 : piece_count(2.0 * glm::length(v), texel_m);
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j < nv; ++j)
      visit(centre + ((2.0 * i + 1.0) / nu - 1.0) * u + ((2.0 * j + 1.0) / nv - 1.0) * v, area / (nu * nv));
}

// The same for wood, seen as the silhouette of a cylinder without end caps.
template <class Visit>
void for_each_piece(const WoodSegment& w, const Vec3& to_light, double texel_m, const Visit& visit) {
  const Vec3 axis = Vec3(w.to_m) - Vec3(w.from_m);
  const Vec3 side = glm::cross(axis, to_light);  // as long as the axis looks from the light
  const double seen_m = glm::length(side);
  if (!(seen_m > 0.0)) return;
  const double widest_m = 2.0 * std::max(w.radius_from_m, w.radius_to_m);
  const int along_axis = piece_count(glm::length(axis), texel_m), sideways = piece_count(widest_m, texel_m);
  for (int i = 0; i < along_axis; ++i) {
    const double t = (i + 0.5) / along_axis;
    const double width_m = 2.0 * (w.radius_from_m + t * (w.radius_to_m - w.radius_from_m));
    for (int j = 0; j < sideways; ++j)
      visit(Vec3(w.from_m) + t * axis + (((j + 0.5) / sideways - 0.5) * width_m / seen_m) * side,
            width_m * seen_m / (along_axis * sideways));
  }
}

// And for meshes, taken as closed surfaces: a ray that meets one goes in and out, so each triangle counts
// half.
template <class Visit>
void for_each_piece(const WoodTriangle& w, const Vec3& to_light, double texel_m, const Visit& visit) {
  const Vec3 a(w.a_m), ab = Vec3(w.b_m) - a, ac = Vec3(w.c_m) - a;
  const double area = 0.25 * std::abs(glm::dot(glm::cross(ab, ac), to_light));
  const int n = piece_count(std::max(glm::length(ab), glm::length(ac)), texel_m);
  for (int i = 0; i < n; ++i)  // n^2 like triangles, upright ones and turned ones
    for (int j = 0; i + j < n; ++j) {
      visit(a + ((i + 1.0 / 3.0) * ab + (j + 1.0 / 3.0) * ac) / static_cast<double>(n), area / (n * n));
      if (i + j + 1 < n)
        visit(a + ((i + 2.0 / 3.0) * ab + (j + 2.0 / 3.0) * ac) / static_cast<double>(n), area / (n * n));
    }
}

}  // namespace sunfleck
