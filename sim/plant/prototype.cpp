#include "sim/plant/prototype.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/base/contract.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

// Half extent of a disc or cylinder rim of radius r around the unit axis n, along each axis: r sqrt(1 -
// n_i^2).
Vec3 rim_extent(const Vec3& axis, double radius) {
  return radius * glm::sqrt(glm::max(Vec3(0.0), Vec3(1.0) - axis * axis));
}

Vec3 unit_or_zero(const Vec3& v) {
  const double length = glm::length(v);
  return length > 0.0 ? v / length : Vec3(0.0);
}

void include_triangle(Box& box, const Vec3& centre, const Vec3& u, const Vec3& v) {
  const Vec3 corner = centre - (u + v) / 3.0;
  box.include(corner);
  box.include(corner + u);
  box.include(corner + v);
}

// Diameter of the stem at breast height: of the thickest segment that crosses 1.3 m near the stem foot's
// axis.
double stem_diameter_at_breast_height(const Prototype& prototype) {
  constexpr double kBreastHeight_m = 1.3;
  double diameter = 0.0;
  for (const WoodSegment& s : prototype.wood) {
    const double z0 = s.from_m.z, z1 = s.to_m.z;
    if (std::min(z0, z1) > kBreastHeight_m || std::max(z0, z1) < kBreastHeight_m || z0 == z1) continue;
    const double t = (kBreastHeight_m - z0) / (z1 - z0);
    diameter = std::max(diameter, 2.0 * (s.radius_from_m + t * (s.radius_to_m - s.radius_from_m)));
  }
  return diameter;
}

double mean_sector_radius(const std::vector<FoliageElement>& foliage) {
  constexpr int kSectors = 8;
  std::array<double, kSectors> reach{};
  for (const FoliageElement& e : foliage) {
    const double radius = std::hypot(e.centre_m.x, e.centre_m.y);
    const double turn = std::atan2(e.centre_m.y, e.centre_m.x) / (2.0 * kPi) + 0.5;  // [0, 1]
    double& sector =
        reach[static_cast<std::size_t>(std::min(kSectors - 1, static_cast<int>(turn * kSectors)))];
    sector = std::max(sector, radius);
  }
  double sum = 0.0;
  for (const double r : reach) sum += r;
  return sum / kSectors;
}

std::string element_problem(const FoliageElement& e, std::size_t materials) {
  if (!is_finite(e.centre_m) || !is_finite(e.half_u_m) || !is_finite(e.half_v_m) || !std::isfinite(e.area_m2))
    return "has a coordinate or area that is not finite";
  if (e.area_m2 < 0.0f) return "has a negative area";
  if (e.shape > ElementShape::kShoot) return "has an unknown shape";
  if (e.material >= materials) return "names a material that its prototype does not have";
  if (e.shape != ElementShape::kShoot &&
      std::abs(element_geometric_area(e) - e.area_m2) > 1e-3 * e.area_m2 + 1e-12)
    return "states an area that is not that of its edges";
  return {};
}

// Of the parallelograms alone: most forests are made of them, and this is asked for often.
Box flat_quad_bounds(const Prototype& prototype) {
  Box box;
  for (const FoliageElement& e : prototype.foliage) {
    if (e.shape != ElementShape::kParallelogram) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const double centre = e.centre_m[axis];
      const double extent =
          std::abs(static_cast<double>(e.half_u_m[axis])) + std::abs(static_cast<double>(e.half_v_m[axis]));
      box.lo[axis] = std::min(box.lo[axis], centre - extent);
      box.hi[axis] = std::max(box.hi[axis], centre + extent);
    }
  }
  return box;
}

}  // namespace

Vec3 element_normal(const FoliageElement& e) {
  SUNFLECK_EXPECTS(e.shape != ElementShape::kShoot);
  return unit_or_zero(glm::cross(Vec3(e.half_u_m), Vec3(e.half_v_m)));
}

double element_geometric_area(const FoliageElement& e) {
  const double cross = glm::length(glm::cross(Vec3(e.half_u_m), Vec3(e.half_v_m)));
  switch (e.shape) {
    case ElementShape::kParallelogram:
      return 4.0 * cross;
    case ElementShape::kDisc:
      return kPi * cross;
    case ElementShape::kTriangle:
      return 0.5 * cross;
    case ElementShape::kShoot:
      break;
  }
  return e.area_m2;
}

Box element_bounds(const FoliageElement& e) {
  const Vec3 centre(e.centre_m), u(e.half_u_m), v(e.half_v_m);
  Box box;
  switch (e.shape) {
    case ElementShape::kParallelogram: {
      const Vec3 extent = glm::abs(u) + glm::abs(v);
      box.include(centre - extent);
      box.include(centre + extent);
      break;
    }
    case ElementShape::kTriangle:
      include_triangle(box, centre, u, v);
      break;
    case ElementShape::kDisc: {
      const Vec3 extent = rim_extent(unit_or_zero(glm::cross(u, v)), glm::length(u));
      box.include(centre - extent);
      box.include(centre + extent);
      break;
    }
    case ElementShape::kShoot: {
      const Vec3 extent = glm::abs(u) + rim_extent(unit_or_zero(u), glm::length(v));
      box.include(centre - extent);
      box.include(centre + extent);
      break;
    }
  }
  return box;
}

Box prototype_bounds(const Prototype& prototype) {
  Box box = flat_quad_bounds(prototype);
  for (const FoliageElement& e : prototype.foliage)
    if (e.shape != ElementShape::kParallelogram) box.include(element_bounds(e));
  for (const WoodSegment& s : prototype.wood) {
    const Vec3 axis = unit_or_zero(Vec3(s.to_m) - Vec3(s.from_m));
    const Vec3 lower = rim_extent(axis, s.radius_from_m), upper = rim_extent(axis, s.radius_to_m);
    box.include(Vec3(s.from_m) - lower);
    box.include(Vec3(s.from_m) + lower);
    box.include(Vec3(s.to_m) - upper);
    box.include(Vec3(s.to_m) + upper);
  }
  for (const WoodTriangle& t : prototype.wood_mesh) {
    box.include(Vec3(t.a_m));
    box.include(Vec3(t.b_m));
    box.include(Vec3(t.c_m));
  }
  return box;
}

double leaf_area_m2(const Prototype& prototype) {
  double area = 0.0;
  for (const FoliageElement& e : prototype.foliage) area += e.area_m2;
  return area;
}

TreeMeasures measure(const Prototype& prototype) {
  TreeMeasures m;
  m.dbh_m = stem_diameter_at_breast_height(prototype);
  if (m.dbh_m == 0.0) m.dbh_m = prototype.stated_dbh_m;
  const Box box = prototype_bounds(prototype);
  m.height_m = box.empty() ? 0.0 : std::max(0.0, box.hi.z);
  m.leaf_area_m2 = leaf_area_m2(prototype);
  if (prototype.foliage.empty()) return m;
  m.crown_base_m = m.height_m;
  for (const FoliageElement& e : prototype.foliage)
    m.crown_base_m = std::min(m.crown_base_m, static_cast<double>(e.centre_m.z));
  m.crown_radius_m = mean_sector_radius(prototype.foliage);
  return m;
}

void validate(const Prototype& prototype, const std::string& where) {
  for (std::size_t i = 0; i < prototype.foliage.size(); ++i) {
    const std::string problem = element_problem(prototype.foliage[i], prototype.materials.size());
    if (!problem.empty())
      throw_invalid(where + ": foliage element " + std::to_string(i), problem,
                    "finite coordinates, area >= 0 equal to that of its edges, material below " +
                        std::to_string(prototype.materials.size()));
  }
  const auto bad_wood = [&](const WoodSegment& s) {
    return !is_finite(s.from_m) || !is_finite(s.to_m) || !(s.radius_from_m >= 0.0f) ||
           !(s.radius_to_m >= 0.0f) || !std::isfinite(s.radius_from_m + s.radius_to_m) ||
           s.material >= prototype.materials.size();
  };
  for (std::size_t i = 0; i < prototype.wood.size(); ++i)
    if (bad_wood(prototype.wood[i]))
      throw_invalid(where + ": wood segment " + std::to_string(i),
                    "is not finite, has a negative radius or an unknown material",
                    "mend or remove the segment");
  const auto bad_triangle = [&](const WoodTriangle& t) {
    return !is_finite(t.a_m) || !is_finite(t.b_m) || !is_finite(t.c_m) ||
           t.material >= prototype.materials.size();
  };
  for (std::size_t i = 0; i < prototype.wood_mesh.size(); ++i)
    if (bad_triangle(prototype.wood_mesh[i]))
      throw_invalid(where + ": wood triangle " + std::to_string(i),
                    "is not finite or has an unknown material", "mend or remove the triangle");
}

}  // namespace sunfleck
