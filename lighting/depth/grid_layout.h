// Where the cells of a leaf-area grid lie: a box of equal cells, repeated in x and y or with a margin of at
// least one empty cell. Lengths in metres, in the frame of the box.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "sim/base/vec.h"

namespace sunfleck {

// Cell size of a scene: clamp(extent / 32, 2 sides, 4 sides). Below 1.5 leaf sides a cell's leaves no longer
// shade like a random medium and depths are wrong by tens of percent; above 4 sides the crown blurs.
double leaf_cell_size(double extent_m, double leaf_side_m);

struct GridLayout {
  Vec3 lo_m{0};    // lower corner
  Vec3 cell_m{1};  // edges of a cell
  std::array<int, 3> cells{3, 3, 3};
  bool wraps_xy = false;   // the grid repeats in x and y
  bool coarsened = false;  // the wanted cells would have been more than allowed

  std::size_t cell_count() const;
  Vec3 size_m() const;
  // Edge of the cube with a cell's volume.
  double mean_cell_m() const;
  // Cell of a point along one axis, limited to the grid.
  int cell_along(int axis, double coordinate_m) const;
  std::array<int, 3> cell_of(const Vec3& point_m) const;
  std::uint32_t flat(const std::array<int, 3>& cell) const;
  std::array<int, 3> unflat(std::uint32_t cell) const;
};

// Layout for points in `box` with cells of `cell_m`, larger if there would be more than `max_cells` of them.
// With a period (its lower corner and size in the frame of the box) x and y cover exactly one period.
GridLayout fit_grid(const Box& box, const std::optional<Box>& period_xy, double cell_m,
                    std::uint64_t max_cells);

}  // namespace sunfleck
