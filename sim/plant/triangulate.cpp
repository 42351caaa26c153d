// Ear clipping (Meisters 1975) in the plane of the polygon's Newell normal. O(n^3) at worst: for faces of
// meshes, which have few corners. A polygon that crosses itself has no ears left at some point; the rest is
// then cut as a fan.
#include <array>

#include "sim/plant/flat_elements.h"

namespace sunfleck {
namespace {

using Triangle = std::array<std::size_t, 3>;

Vec3 newell_normal(std::span<const Vec3> corners_m) {
  Vec3 normal(0.0);
  for (std::size_t i = 0; i < corners_m.size(); ++i)
    normal += glm::cross(corners_m[i] - corners_m[0], corners_m[(i + 1) % corners_m.size()] - corners_m[0]);
  return normal;
}

// Twice the area of a triangle seen against the normal, negative if it turns the other way.
double turn(std::span<const Vec3> p, const Triangle& t, const Vec3& normal) {
  return glm::dot(glm::cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]), normal);
}

bool is_ear(std::span<const Vec3> p, const std::vector<std::size_t>& rest, const Triangle& t,
            const Vec3& normal) {
  if (turn(p, t, normal) <= 0.0) return false;
  for (const std::size_t other : rest) {
    if (other == t[0] || other == t[1] || other == t[2]) continue;
    if (turn(p, {t[0], t[1], other}, normal) >= 0.0 && turn(p, {t[1], t[2], other}, normal) >= 0.0 &&
        turn(p, {t[2], t[0], other}, normal) >= 0.0)
      return false;
  }
  return true;
}

// Position of the corner in `rest` that is cut off next: an ear, else the second (fan).
std::size_t next_cut(std::span<const Vec3> p, const std::vector<std::size_t>& rest, const Vec3& normal) {
  for (std::size_t k = 0; k < rest.size(); ++k) {
    const Triangle t = {rest[(k + rest.size() - 1) % rest.size()], rest[k], rest[(k + 1) % rest.size()]};
    if (is_ear(p, rest, t, normal)) return k;
  }
  return 1;
}

}  // namespace

std::vector<Triangle> triangulate(std::span<const Vec3> corners_m) {
  std::vector<std::size_t> rest(corners_m.size());
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = i;
  const Vec3 normal = newell_normal(corners_m);
  std::vector<Triangle> triangles;
  while (rest.size() > 3) {
    const std::size_t k = next_cut(corners_m, rest, normal);
    triangles.push_back({rest[(k + rest.size() - 1) % rest.size()], rest[k], rest[(k + 1) % rest.size()]});
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(k));
  }
  if (rest.size() == 3) triangles.push_back({rest[0], rest[1], rest[2]});
  return triangles;
}

}  // namespace sunfleck
