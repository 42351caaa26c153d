#include "sim/grid/forest_parts.h"

#include "sim/grid/forest_tables.h"

namespace sunfleck {

void fill_prototype(const TablesByName& tables, std::size_t index, const PrototypeCounts& counts,
                    Prototype& prototype) {
  prototype.foliage = tables.rows(grid_name(kElementsGrid, index), counts.foliage, foliage_from);
  prototype.wood = tables.rows(grid_name(kWoodGrid, index), counts.wood, wood_from);
  prototype.wood_mesh = tables.rows(grid_name(kWoodMeshGrid, index), counts.wood_mesh, wood_mesh_from);
}

}  // namespace sunfleck
