#include "lighting/shade/billboard_cells.h"

#include <algorithm>
#include <cmath>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

constexpr std::size_t kMostEntries = (1u << 24) - 1, kMostPerCell = 255;

LowResTexel low_res_of(const CellLeaves& cell) {
  int covered = 0;
  for (const std::uint16_t row : cell.covered) covered += __builtin_popcount(row);
  LowResTexel texel;
  texel.cover = static_cast<std::uint8_t>(std::lround(255.0 * covered / (kCellSamples * kCellSamples)));
  const double length = glm::length(cell.normal);
  for (int k = 0; k < 3 && length > 0; ++k)
    texel.normal[static_cast<std::size_t>(k)] =
        static_cast<std::int8_t>(std::lround(127 * cell.normal[k] / length));
  return texel;
}

}  // namespace

void enter_leaf(CellGrid& grid, const FlatLeaf& leaf, const LeafMask& mask, std::uint16_t number) {
  const Bounds2 bounds = bounds_of(leaf);
  const auto cell_of = [](double at, double size, int count) {
    return std::clamp(static_cast<int>(std::floor(at / size)), 0, count - 1);
  };
  const int u0 = cell_of(bounds.lo.x - grid.corner.x, grid.cell.x, grid.cells_u);
  const int u1 = cell_of(bounds.hi.x - grid.corner.x, grid.cell.x, grid.cells_u);
  const int v0 = cell_of(bounds.lo.y - grid.corner.y, grid.cell.y, grid.cells_v);
  const int v1 = cell_of(bounds.hi.y - grid.corner.y, grid.cell.y, grid.cells_v);
  for (int row = v0; row <= v1; ++row)
    for (int column = u0; column <= u1; ++column) {
      CellLeaves& cell = grid.cells[static_cast<std::size_t>(row * grid.cells_u + column)];
      const Vec2 origin = grid.corner + Vec2(column, row) * grid.cell;
      int found = 0;
      for (int y = 0; y < kCellSamples; ++y)
        for (int x = 0; x < kCellSamples; ++x)
          if (covers(leaf, mask, origin + Vec2(x + 0.5, y + 0.5) / double(kCellSamples) * grid.cell)) {
            cell.covered[static_cast<std::size_t>(y)] |= static_cast<std::uint16_t>(1u << x);
            ++found;
          }
      if (found == 0) continue;
      const double height = leaf.height + glm::dot(leaf.rise, origin + 0.5 * grid.cell - leaf.centre);
      cell.entry.emplace_back(height, number);
      cell.normal += static_cast<double>(found) * leaf.normal;
    }
}

void append_cells(BillboardCloud& cloud, CellGrid& grid) {
  for (CellLeaves& cell : grid.cells) {
    cloud.low_res.push_back(low_res_of(cell));
    if (cloud.low_res_only) continue;
    std::sort(cell.entry.begin(), cell.entry.end());
    const std::size_t count = std::min(cell.entry.size(), kMostPerCell);
    cloud.left_out += cell.entry.size() - count;
    if (cloud.list.size() + count > kMostEntries)
      throw Error(ErrorKind::kLimitExceeded, "billboards", "more than 16.7 million list entries",
                  "larger cells");
    cloud.cell.push_back(count == 0 ? 0 : static_cast<std::uint32_t>(cloud.list.size() << 8 | count));
    for (std::size_t i = 0; i < count; ++i) cloud.list.push_back(cell.entry[i].second);
  }
}

}  // namespace sunfleck
