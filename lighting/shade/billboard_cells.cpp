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

struct CellRange {
  int u0, u1, v0, v1;
};

CellRange cells_around(const CellGrid& grid, const Bounds2& bounds, double reach_m) {
  const auto cell_of = [](double at, double size, int count) {
    return std::clamp(static_cast<int>(std::floor(at / size)), 0, count - 1);
  };
  const Vec2 lo = bounds.lo - reach_m - grid.corner, hi = bounds.hi + reach_m - grid.corner;
  return {cell_of(lo.x, grid.cell.x, grid.cells_u), cell_of(hi.x, grid.cell.x, grid.cells_u),
          cell_of(lo.y, grid.cell.y, grid.cells_v), cell_of(hi.y, grid.cell.y, grid.cells_v)};
}

// Marks the cell's samples that the leaf covers; how many.
int cover_samples(CellLeaves& cell, const FlatLeaf& leaf, const LeafMask& mask, const Vec2& origin,
                  const Vec2& size) {
  const Bounds2 bounds = bounds_of(leaf);
  if (glm::any(glm::lessThan(bounds.hi, origin)) || glm::any(glm::greaterThan(bounds.lo, origin + size)))
    return 0;
  int found = 0;
  for (int y = 0; y < kCellSamples; ++y)
    for (int x = 0; x < kCellSamples; ++x)
      if (covers(leaf, mask, origin + Vec2(x + 0.5, y + 0.5) / double(kCellSamples) * size)) {
        cell.covered[static_cast<std::size_t>(y)] |= static_cast<std::uint16_t>(1u << x);
        ++found;
      }
  return found;
}

// Points all over the leaf, its rim included; its centre first, which mostly answers.
std::vector<Vec2> points_of(const FlatLeaf& leaf, const LeafMask& mask) {
  constexpr int side = 12;
  std::vector<Vec2> points{leaf.centre};
  for (int y = 0; y <= side; ++y)
    for (int x = 0; x <= side; ++x) {
      const double a = 0.9999 * (2.0 * x / side - 1), b = 0.9999 * (2.0 * y / side - 1);
      if (mask.covers(a, b)) points.push_back(leaf.centre + a * leaf.half_u + b * leaf.half_v);
    }
  return points;
}

bool is_near(const std::vector<Vec2>& points, const Vec2& origin, const Vec2& size, double reach_m) {
  return std::any_of(points.begin(), points.end(), [&](const Vec2& p) {
    const Vec2 off = p - glm::clamp(p, origin, origin + size);
    return glm::dot(off, off) <= reach_m * reach_m;
  });
}

}  // namespace

void enter_leaf(CellGrid& grid, const FlatLeaf& leaf, const LeafMask& mask, std::uint16_t number,
                double reach_m) {
  const std::vector<Vec2> points = reach_m > 0 ? points_of(leaf, mask) : std::vector<Vec2>{};
  const CellRange range = cells_around(grid, bounds_of(leaf), reach_m);
  for (int row = range.v0; row <= range.v1; ++row)
    for (int column = range.u0; column <= range.u1; ++column) {
      CellLeaves& cell = grid.cells[static_cast<std::size_t>(row * grid.cells_u + column)];
      const Vec2 origin = grid.corner + Vec2(column, row) * grid.cell;
      const int found = cover_samples(cell, leaf, mask, origin, grid.cell);
      if (found == 0 && !is_near(points, origin, grid.cell, reach_m)) continue;
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
