// See grid_layout.h.
#include "lighting/depth/grid_layout.h"

#include <algorithm>
#include <cmath>

#include "sim/base/contract.h"

namespace sunfleck {

namespace {

// Cells to hold `extent_m` between margins of at least one cell; three where there is no extent.
double cells_with_margin(double extent_m, double cell_m) { return std::floor(extent_m / cell_m) + 3.0; }

std::array<double, 3> wanted_cells(const Vec3& size_m, const std::optional<Box>& period_xy, double cell_m) {
  std::array<double, 3> cells;
  for (int axis = 0; axis < 3; ++axis) {
    const bool wraps = period_xy && axis < 2;
    cells[axis] = wraps ? std::max(1.0, std::round(period_xy->size()[axis] / cell_m))
                        : cells_with_margin(size_m[axis], cell_m);
  }
  return cells;
}

}  // namespace

double leaf_cell_size(double extent_m, double leaf_side_m) {
  SUNFLECK_EXPECTS(extent_m >= 0.0 && leaf_side_m > 0.0);
  return std::clamp(extent_m / 32.0, 2.0 * leaf_side_m, 4.0 * leaf_side_m);
}

std::size_t GridLayout::cell_count() const {
  return static_cast<std::size_t>(cells[0]) * static_cast<std::size_t>(cells[1]) *
         static_cast<std::size_t>(cells[2]);
}

Vec3 GridLayout::size_m() const { return cell_m * Vec3(cells[0], cells[1], cells[2]); }

double GridLayout::mean_cell_m() const { return std::cbrt(cell_m.x * cell_m.y * cell_m.z); }

int GridLayout::cell_along(int axis, double coordinate_m) const {
  const double cell = std::floor((coordinate_m - lo_m[axis]) / cell_m[axis]);
  return static_cast<int>(std::clamp(cell, 0.0, static_cast<double>(cells[axis] - 1)));
}

std::array<int, 3> GridLayout::cell_of(const Vec3& point_m) const {
  return {cell_along(0, point_m.x), cell_along(1, point_m.y), cell_along(2, point_m.z)};
}

std::uint32_t GridLayout::flat(const std::array<int, 3>& cell) const {
  return static_cast<std::uint32_t>((cell[2] * static_cast<std::int64_t>(cells[1]) + cell[1]) * cells[0] +
                                    cell[0]);
}

std::array<int, 3> GridLayout::unflat(std::uint32_t cell) const {
  const std::uint32_t nx = static_cast<std::uint32_t>(cells[0]), ny = static_cast<std::uint32_t>(cells[1]);
  return {static_cast<int>(cell % nx), static_cast<int>(cell / nx % ny), static_cast<int>(cell / nx / ny)};
}

GridLayout fit_grid(const Box& box, const std::optional<Box>& period_xy, double cell_m,
                    std::uint64_t max_cells) {
  SUNFLECK_EXPECTS(!box.empty() && cell_m > 0.0 && max_cells >= 27 && max_cells < (1ull << 32));
  GridLayout layout;
  auto cells = wanted_cells(box.size(), period_xy, cell_m);
  while (cells[0] * cells[1] * cells[2] > static_cast<double>(max_cells)) {
    layout.coarsened = true;
    cell_m *= 1.01 *
              std::max(1.0, 0.5 * std::cbrt(cells[0] * cells[1] * cells[2] / static_cast<double>(max_cells)));
    cells = wanted_cells(box.size(), period_xy, cell_m);
  }
  layout.wraps_xy = period_xy.has_value();
  for (int axis = 0; axis < 3; ++axis) {
    layout.cells[axis] = static_cast<int>(cells[axis]);
    const bool wraps = period_xy && axis < 2;
    layout.cell_m[axis] = wraps ? period_xy->size()[axis] / cells[axis] : cell_m;
    layout.lo_m[axis] = wraps ? period_xy->lo[axis] : box.centre()[axis] - 0.5 * cells[axis] * cell_m;
  }
  return layout;
}

}  // namespace sunfleck
