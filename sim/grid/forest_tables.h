// The elements, wood and instances of a forest as tables, and back. Every number of a row is in a column, so
// that nothing is rounded.
#pragma once

#include <span>
#include <vector>

#include "sim/forest/forest.h"
#include "sim/grid/point_table.h"

namespace sunfleck {

// Grid names of a prototype: kind + "_" + index, as in "elements_12".
std::string grid_name(const char* kind, std::size_t prototype);
inline constexpr const char* kElementsGrid = "elements";
inline constexpr const char* kWoodGrid = "wood";
inline constexpr const char* kWoodMeshGrid = "wood_mesh";
inline constexpr const char* kLeafAreaGrid = "leaf_area_density";
inline constexpr const char* kInstancesGrid = "instances";

// Three tables per prototype (empty ones too) and one of the instances.
std::vector<PointTable> tables_of(const Forest& forest);

// The inverse of each kind; throws std::runtime_error if a column is missing or of another type or length.
std::vector<FoliageElement> foliage_from(const PointTable& table);
std::vector<WoodSegment> wood_from(const PointTable& table);
std::vector<WoodTriangle> wood_mesh_from(const PointTable& table);
std::vector<Instance> instances_from(const PointTable& table);

}  // namespace sunfleck
