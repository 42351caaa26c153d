// Points that stand for a surface larger than a grid cell: an even pattern over it, each with its share of
// the area, two per cell and edge, so that every cell it lies in gets its part.
#pragma once

#include <vector>

#include "sim/base/vec.h"
#include "sim/forest/forest.h"

namespace sunfleck {

struct SpreadPoint {
  Vec3 point_m;
  double share;  // sums to 1
};

// Most points along one edge of a surface.
inline constexpr int kMostPointsPerEdge = 64;

// True if the element does not fit a cell: longer than it, or more than a quarter of its face in area.
bool needs_spreading(const WorldElement& element, double cell_m);
std::vector<SpreadPoint> spread_element(const WorldElement& element, double cell_m);

// A tapered cylinder between two points; shares follow the radius.
struct WorldCylinder {
  Vec3 from_m, to_m;
  double radius_from_m, radius_to_m;
};
std::vector<SpreadPoint> spread_cylinder(const WorldCylinder& cylinder, double cell_m);
std::vector<SpreadPoint> spread_triangle(const Vec3& a_m, const Vec3& b_m, const Vec3& c_m, double cell_m);

}  // namespace sunfleck
