#include "sim/plant/flat_elements.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

constexpr double kParallelogramTolerance = 1e-3;  // of the longest edge
constexpr double kFarthest_m = 1e4;               // single precision resolves 1 mm there
constexpr double kLeastArea_m2 = 1e-14;           // a square of 0.1 micrometre

bool is_parallelogram(std::span<const Vec3> c) {
  if (c.size() != 4) return false;
  double longest_m = 0.0;
  for (std::size_t i = 0; i < 4; ++i) longest_m = std::max(longest_m, glm::distance(c[i], c[(i + 1) % 4]));
  return glm::length(c[0] - c[1] + c[2] - c[3]) <= kParallelogramTolerance * longest_m;
}

// The parallelogram of the mean opposite edges; its area is that of a planar quad exactly (half the product
// of the diagonals).
FoliageElement make_parallelogram(std::span<const Vec3> c) {
  const Vec3 u = 0.25 * ((c[1] + c[2]) - (c[0] + c[3])), v = 0.25 * ((c[2] + c[3]) - (c[0] + c[1]));
  FoliageElement element;
  element.centre_m = Vec3f(0.25 * (c[0] + c[1] + c[2] + c[3]));
  element.half_u_m = Vec3f(u);
  element.half_v_m = Vec3f(v);
  element.area_m2 = static_cast<float>(element_geometric_area(element));
  return element;
}

double triangle_area_m2(const Vec3& a, const Vec3& b, const Vec3& c) {
  return 0.5 * glm::length(glm::cross(b - a, c - a));
}

}  // namespace

FoliageElement make_disc(const Vec3& centre_m, const Vec3& unit_normal, double radius_m) {
  const Basis basis = basis_around(unit_normal);
  FoliageElement element;
  element.shape = ElementShape::kDisc;
  element.centre_m = Vec3f(centre_m);
  element.half_u_m = Vec3f(radius_m * basis.tangent);
  element.half_v_m = Vec3f(radius_m * basis.bitangent);
  element.area_m2 = static_cast<float>(element_geometric_area(element));
  return element;
}

FoliageElement make_triangle(const Vec3& a_m, const Vec3& b_m, const Vec3& c_m) {
  FoliageElement element;
  element.shape = ElementShape::kTriangle;
  element.centre_m = Vec3f((a_m + b_m + c_m) / 3.0);
  element.half_u_m = Vec3f(b_m - a_m);
  element.half_v_m = Vec3f(c_m - a_m);
  element.area_m2 = static_cast<float>(element_geometric_area(element));
  return element;
}

void add_leaf_polygon(std::span<const Vec3> corners_m, std::uint16_t material,
                      std::vector<FoliageElement>& foliage, ImportReport& report) {
  const auto keep = [&](FoliageElement element, std::size_t& counter) {
    if (element.area_m2 < kLeastArea_m2) return void(++report.degenerate_skipped);
    element.material = material;
    foliage.push_back(element);
    ++counter;
  };
  if (is_parallelogram(corners_m)) return keep(make_parallelogram(corners_m), report.parallelograms);
  for (const auto& t : triangulate(corners_m))
    keep(make_triangle(corners_m[t[0]], corners_m[t[1]], corners_m[t[2]]), report.triangles);
}

void add_wood_polygon(std::span<const Vec3> corners_m, std::uint32_t material,
                      std::vector<WoodTriangle>& wood, ImportReport& report) {
  for (const auto& t : triangulate(corners_m)) {
    const Vec3 &a = corners_m[t[0]], &b = corners_m[t[1]], &c = corners_m[t[2]];
    if (triangle_area_m2(a, b, c) < kLeastArea_m2) {
      ++report.degenerate_skipped;
      continue;
    }
    wood.push_back({Vec3f(a), Vec3f(b), Vec3f(c), material});
    ++report.wood_triangles;
  }
}

void finish_import(const std::string& file, const Prototype& prototype, ImportReport& report) {
  if (prototype.foliage.empty() && prototype.wood_mesh.empty())
    throw_invalid(file, "holds no leaf and no wood",
                  "give a file with at least one disc, quad or face of some area");
  if (report.degenerate_skipped > 0)
    report.warnings.push_back(file + ": skipped " + std::to_string(report.degenerate_skipped) +
                              " faces without area");
  const double lowest_m = prototype_bounds(prototype).lo.z;
  if (lowest_m < -0.01)
    report.warnings.push_back(file + ": reaches " + std::to_string(-lowest_m) +
                              " m below z = 0; the stem foot should be at the origin, z up");
  validate(prototype, file);
}

void require_near_origin(const Vec3& point_m, const std::string& where) {
  if (std::max({std::abs(point_m.x), std::abs(point_m.y), std::abs(point_m.z)}) > kFarthest_m)
    throw_invalid(where, "a coordinate is more than 10 km from the origin",
                  "give metres in the tree's own frame, the stem foot at the origin");
}

}  // namespace sunfleck
