// See leaf_clumping.h.
#include "lighting/transport/leaf_clumping.h"

#include <algorithm>

#include "lighting/depth/grid_layout.h"
#include "sim/base/contract.h"

namespace sunfleck::transport {

namespace {

double pairs_in_cells(const std::vector<std::uint32_t>& leaves) {
  double pairs = 0.0;
  for (const std::uint32_t n : leaves) pairs += static_cast<double>(n) * (n - 1.0);
  return pairs;
}

std::vector<std::uint32_t> leaves_of_cells(const Prototype& prototype, const GridLayout& layout) {
  std::vector<std::uint32_t> leaves(layout.cell_count());
  for (const FoliageElement& e : prototype.foliage) ++leaves[layout.flat(layout.cell_of(Vec3(e.centre_m)))];
  return leaves;
}

// Cells of `wide` are twice as wide as those of `layout` and begin in the same corner.
std::vector<std::uint32_t> in_wide_cells(const std::vector<std::uint32_t>& leaves, const GridLayout& layout,
                                         const GridLayout& wide) {
  std::vector<std::uint32_t> sums(wide.cell_count());
  for (std::uint32_t c = 0; c < leaves.size(); ++c) {
    const auto [x, y, z] = layout.unflat(c);
    sums[wide.flat({x / 2, y / 2, z / 2})] += leaves[c];
  }
  return sums;
}

}  // namespace

double leaf_clumping(const Prototype& prototype, double cell_m) {
  if (prototype.foliage.empty()) return 1.0;
  Box box;
  for (const FoliageElement& e : prototype.foliage) box.include(Vec3(e.centre_m));
  SUNFLECK_EXPECTS(cell_m > 0.0 && std::max({box.size().x, box.size().y, box.size().z}) <= 257.0 * cell_m);
  GridLayout layout, wide;
  layout.lo_m = wide.lo_m = box.lo;
  layout.cell_m = Vec3(cell_m);
  wide.cell_m = Vec3(2.0 * cell_m);
  for (int axis = 0; axis < 3; ++axis) {
    layout.cells[axis] = static_cast<int>(box.size()[axis] / cell_m) + 1;
    wide.cells[axis] = (layout.cells[axis] + 1) / 2;
  }
  const std::vector<std::uint32_t> leaves = leaves_of_cells(prototype, layout);
  const double near = pairs_in_cells(leaves), far = pairs_in_cells(in_wide_cells(leaves, layout, wide));
  return near < 2.0 * kFewestPairs ? 1.0 : 8.0 * near / far;
}

}  // namespace sunfleck::transport
