// Leaf area density of a prototype on a regular grid of cubes.
#pragma once

#include <string>

#include "sim/grid/point_table.h"
#include "sim/plant/prototype.h"

namespace sunfleck {

// Edge of the cells: a 32nd of the crown, but 2 to 4 sides of its elements: finer cells hold single leaves,
// coarser ones lose the crown's gaps.
double leaf_area_cell_m(const Prototype& prototype);

// One-sided leaf area per volume (m2/m3). Each element counts whole in the cell that holds its centre.
DensityGrid leaf_area_grid(const Prototype& prototype, const std::string& name);

}  // namespace sunfleck
