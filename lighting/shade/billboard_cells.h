// The cells of one plane being filled: which leaves each holds, in which order. Private to the folder.
#pragma once

#include <utility>

#include "lighting/shade/billboard_leaf.h"

namespace sunfleck {

inline constexpr int kCellSamples = 16;  // per side, to see which leaves a cell holds

// One cell being filled: which leaves it holds, at what height, and what far views see of it.
struct CellLeaves {
  std::vector<std::pair<double, std::uint16_t>> entry;  // height at the cell's middle, record
  std::array<std::uint16_t, kCellSamples> covered{};    // sample bits, row by row
  Vec3 normal{0};
};

struct CellGrid {
  Vec2 corner{0}, cell{0};
  int cells_u = 0, cells_v = 0;
  std::vector<CellLeaves> cells;
};

// Into the list of every cell where a view may show it: its outline and `reach_m` around it; what it covers
// itself counts for the low-resolution texture.
void enter_leaf(CellGrid& grid, const FlatLeaf& leaf, const LeafMask& mask, std::uint16_t number,
                double reach_m);

// Lists, cells and low-resolution texels of a filled grid. Throws Error(kLimitExceeded) as
// build_billboard_cloud.
void append_cells(BillboardCloud& cloud, CellGrid& grid);

}  // namespace sunfleck
