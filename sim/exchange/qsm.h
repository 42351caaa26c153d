// Quantitative structure models (QSM): the wood of one tree as a table of cylinders, one per row.
//
// Columns are found by name; case, blanks, `_`, `.`, brackets and a unit "m" do not matter:
//   start x y z      startX, start_x_m, start_point_1, x ...               required
//   end x y z        endX, end_x_m ...            or axis x y z (axisX, axis_direction_1 ...) with length
//   radius           radius, radius_cyl, radius_m; or radius_start and radius_end of a tapered one
//   id, parent       id, cyl_ID, cylinder_id; parent, parent_ID: optional, checked where there
// Metres. These are the names that the usual programs write (TreeQSM, SimpleForest, aRchi, rTwig).
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/plant/make_prototype.h"
#include "sim/plant/prototype.h"

namespace sunfleck {

struct QsmReport {
  std::size_t cylinders = 0;
  std::size_t degenerate_skipped = 0;  // no length or no radius
  Vec3 moved_m{0};                     // added to all coordinates
  std::vector<std::string> warnings;
};

// Wood only; `material` is the species. A tree whose lowest cylinder without a parent (without parent column:
// lowest cylinder) starts more than 1 m from the origin is moved there, which the report says: scanned trees
// come in map coordinates. Reads .gz. Throws Error(kInvalidInput) with file, line and column: column missing,
// not a number, negative or > 10 m radius, unknown parent, no cylinder at all.
Prototype import_qsm(const std::filesystem::path& path, const std::string& material,
                     QsmReport* report = nullptr);

// Columns id, parent_id, branch_order, start_*_m, end_*_m, radius_start_m, radius_end_m, radius_m (mean),
// length_m. The parent is the segment at whose end (else: at whose start) another one starts, 0 for none; the
// thickest continuation keeps the order of its parent. Throws Error(kInvalidInput) for a prototype without
// wood segments; returns how many mesh triangles of wood the format cannot hold.
std::size_t export_qsm(const Prototype& prototype, const std::filesystem::path& path);

// Parents as export_qsm states them: index into `wood`, or -1.
std::vector<int> wood_parents(const std::vector<WoodSegment>& wood);

}  // namespace sunfleck
