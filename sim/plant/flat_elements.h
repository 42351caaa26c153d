// Flat foliage elements from corners: the one place that knows how a face becomes an element.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/plant/make_prototype.h"
#include "sim/plant/prototype.h"

namespace sunfleck {

FoliageElement make_disc(const Vec3& centre_m, const Vec3& unit_normal, double radius_m);
FoliageElement make_triangle(const Vec3& a_m, const Vec3& b_m, const Vec3& c_m);

// Corner indexes of triangles that cover a polygon without holes: fan for a triangle, ears clipped in the
// plane of the polygon's mean normal otherwise, so that concave corners are right.
std::vector<std::array<std::size_t, 3>> triangulate(std::span<const Vec3> corners_m);

// Appends the polygon as one parallelogram (four corners, opposite edges equal to 1e-3 of the longest), or
// as triangles; counts in `report` and skips what has no area.
void add_leaf_polygon(std::span<const Vec3> corners_m, std::uint16_t material,
                      std::vector<FoliageElement>& foliage, ImportReport& report);
void add_wood_polygon(std::span<const Vec3> corners_m, std::uint32_t material,
                      std::vector<WoodTriangle>& wood, ImportReport& report);

// Warnings that any import shares: skipped faces, foliage below the ground, nothing imported (an Error).
void finish_import(const std::string& file, const Prototype& prototype, ImportReport& report);

// Refuses coordinates so far from the origin that single precision would lose the shape of a leaf.
void require_near_origin(const Vec3& point_m, const std::string& where);

}  // namespace sunfleck
