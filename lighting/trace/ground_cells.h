// The ground as receivers: a grid of Lambertian cells over the period, or over the forest's bounds and a
// margin as wide as the forest is high. Light is the same all over a cell; beyond the grid the ground is lit
// as if nothing stood there.
#pragma once

#include <cstdint>

#include "sim/forest/forest.h"

namespace sunfleck::trace {

struct GroundCells {
  Vec2 lo_m{0}, cell_m{1, 1};
  std::uint32_t nx = 0, ny = 0;  // 0: no ground
  Vec3 normal{0, 0, 1};
  bool periodic = false;

  std::uint32_t count() const { return nx * ny; }
  double cell_area_m2() const { return cell_m.x * cell_m.y / normal.z; }  // of the tilted cell
  // Cell under a point (for a periodic forest: of the base cell); count() beyond the grid.
  std::uint32_t cell_at(const Vec3& p) const;
};

// `wanted_cell_m` 0: between 256 and 4096 cells by the number of elements. Throws Error(kLimitExceeded) for
// more than 4 million cells.
GroundCells ground_cells_for(const Forest& forest, double wanted_cell_m);

}  // namespace sunfleck::trace
