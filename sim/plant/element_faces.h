// Elements and wood as polygons, for export and drawing.
#pragma once

#include <array>
#include <vector>

#include "sim/plant/prototype.h"

namespace sunfleck {

// Corners in order, counter-clockwise seen from the front: four of a parallelogram, three of a triangle,
// eight of the octagon that has the disc's area (its corners reach 5.4 % beyond the rim). Not for shoots.
std::vector<Vec3> leaf_corners(const FoliageElement& element);

// The eight side faces of a tapered prism around the axis, corners on the circles, seen from outside.
std::vector<std::array<Vec3, 4>> prism_sides(const Vec3& from_m, const Vec3& to_m, double radius_from_m,
                                             double radius_to_m);

}  // namespace sunfleck
