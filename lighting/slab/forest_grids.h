// The low-resolution grid of every instance ([SPP] section 5.1): cubic cells over the foliage of its
// prototype, only those that hold an element.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/forest/forest.h"

namespace sunfleck {

struct PrototypeGrid {
  double cell_m = 0;
  std::vector<std::uint32_t> cell_of_element;
  std::vector<std::uint32_t> first;     // of each cell in `elements`, one more at the end
  std::vector<std::uint32_t> elements;  // by cell
  std::vector<Vec3> centre_m;           // mean of the cell's element centres, tree frame

  std::size_t cells() const { return centre_m.size(); }
};

// The middles of a grid's cells as rows.
struct CellCentres {
  std::vector<float> x, y, z;

  explicit CellCentres(const PrototypeGrid& grid);
};

// `resolution`: cells along the longest side of the foliage.
PrototypeGrid make_prototype_grid(const Prototype& prototype, int resolution);

struct ForestGrids {
  std::vector<PrototypeGrid> prototypes;
  std::vector<std::size_t> first_cell;  // of each instance, one more at the end

  std::size_t cells() const { return first_cell.back(); }
  std::size_t instance_of(std::size_t cell) const;  // O(log instances)
};
ForestGrids make_forest_grids(const Forest& forest, int resolution);

}  // namespace sunfleck
