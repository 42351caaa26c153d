#include "lighting/shade/billboard_cloud.h"

#include <algorithm>
#include <cmath>

#include "lighting/shade/billboard_cells.h"
#include "lighting/shade/mask_leaves.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

constexpr std::size_t kMostRecords = 65535;

// The plane's relief, and room on its rectangle for leaves that views shift.
void widen_for_relief(const std::vector<FlatLeaf>& leaves, double tangent, Billboard& board,
                      Bounds2& bounds) {
  for (const FlatLeaf& leaf : leaves) {
    const double reach = tangent * std::abs(leaf.height);
    const Bounds2 own = bounds_of(leaf);
    bounds.include(own.lo - reach);
    bounds.include(own.hi + reach);
    board.relief_m = std::max(board.relief_m, std::abs(leaf.height));
  }
}

void append_plane(BillboardCloud& cloud, std::span<const FoliageElement> foliage, const LeafPlane& plane,
                  const BillboardOptions& options, double cell_m,
                  std::span<const std::array<float, 4>> ambient) {
  const Basis axes = spread_axes(foliage, plane);
  std::vector<FlatLeaf> leaves;
  Bounds2 bounds;
  for (const std::uint32_t i : plane.leaves) {
    leaves.push_back(flat_leaf(foliage[i], plane, axes, options.turn_into_plane));
    const Bounds2 own = bounds_of(leaves.back());
    bounds.include(own.lo);
    bounds.include(own.hi);
  }
  Billboard board;
  const double tangent = options.relief_tangent;
  if (tangent > 0) widen_for_relief(leaves, tangent, board, bounds);
  board.along_u = axes.tangent, board.along_v = axes.bitangent, board.normal = plane.normal;
  board.corner_m = plane.centre + bounds.lo.x * axes.tangent + bounds.lo.y * axes.bitangent;
  board.width_m = std::max(bounds.hi.x - bounds.lo.x, 1e-9);
  board.height_m = std::max(bounds.hi.y - bounds.lo.y, 1e-9);
  board.cells_u = std::max(1, static_cast<int>(std::ceil(board.width_m / cell_m)));
  board.cells_v = std::max(1, static_cast<int>(std::ceil(board.height_m / cell_m)));
  board.first_cell = static_cast<std::uint32_t>(cloud.low_res.size());
  board.first_record = static_cast<std::uint32_t>(cloud.record.size());
  if (leaves.size() > kMostRecords)
    throw Error(ErrorKind::kLimitExceeded, "billboards", "more than 65,535 leaves on one plane",
                "more planes");
  CellGrid grid{bounds.lo,
                Vec2(board.width_m / board.cells_u, board.height_m / board.cells_v),
                board.cells_u,
                board.cells_v,
                {}};
  grid.cells.resize(static_cast<std::size_t>(board.cells_u) * static_cast<std::size_t>(board.cells_v));
  for (std::size_t k = 0; k < leaves.size(); ++k) {
    const std::uint32_t leaf = plane.leaves[k];
    enter_leaf(grid, leaves[k], cloud.mask[static_cast<std::size_t>(leaves[k].shape)],
               static_cast<std::uint16_t>(k), tangent * std::abs(leaves[k].height));
    if (cloud.low_res_only) continue;
    const std::array<float, 4> open{1, 1, 1, 1};
    cloud.record.push_back(
        packed(leaves[k], board, bounds.lo, cloud.edge_scale_m, ambient.empty() ? open : ambient[leaf]));
    cloud.leaf.push_back(leaf);
  }
  append_cells(cloud, grid);
  cloud.plane.push_back(board);
}

}  // namespace

LeafMask leaf_mask(ElementShape shape) {
  LeafMask mask;
  for (unsigned y = 0; y < 64; ++y)
    for (unsigned x = 0; x < 64; ++x)
      if (leaf_covers(shape, (x + 0.5) / 32 - 1, (y + 0.5) / 32 - 1)) mask.row[y] |= std::uint64_t{1} << x;
  return mask;
}

BillboardOptions published_billboards(int planes) {
  BillboardOptions options;
  options.clusters.planes = planes;
  options.clusters.angle_weight = 20;
  options.cell_half_edges = 3;
  options.turn_into_plane = false;
  options.relief_tangent = 0;
  return options;
}

BillboardCloud build_billboard_cloud(const Prototype& prototype, const BillboardOptions& options,
                                     std::span<const std::array<float, 4>> ambient,
                                     const RunControl& control) {
  if (!(options.cell_half_edges >= 1 && options.cell_half_edges <= 64))
    throw_invalid("billboard cells", std::to_string(options.cell_half_edges), "1 to 64 half edges of a leaf");
  if (!(options.relief_tangent >= 0 && options.relief_tangent <= 8))
    throw_invalid("billboard relief", std::to_string(options.relief_tangent), "a tangent from 0 to 8");
  if (!ambient.empty() && ambient.size() != prototype.foliage.size())
    throw_invalid("billboard ambient", std::to_string(ambient.size()) + " leaves",
                  "as many as the foliage has");
  const std::vector<LeafPlane> planes = cluster_leaves(prototype.foliage, options.clusters, control);
  BillboardCloud cloud;
  cloud.low_res_only = options.low_res_only;
  cloud.relief_tangent = options.relief_tangent;
  for (int shape = 0; shape < 4; ++shape)
    cloud.mask[static_cast<std::size_t>(shape)] = leaf_mask(static_cast<ElementShape>(shape));
  double mean_m = 0;
  cloud.edge_scale_m = 0;
  for (const FoliageElement& e : prototype.foliage) {
    const double u = static_cast<double>(glm::length(e.half_u_m)),
                 v = static_cast<double>(glm::length(e.half_v_m));
    mean_m += 0.5 * (u + v) / static_cast<double>(prototype.foliage.size());
    cloud.edge_scale_m = std::max({cloud.edge_scale_m, u, v});
  }
  for (const LeafPlane& plane : planes) {
    control.check();
    append_plane(cloud, prototype.foliage, plane, options, options.cell_half_edges * mean_m, ambient);
  }
  return cloud;
}

BillboardMemory billboard_memory(const BillboardCloud& cloud) {
  return {cloud.cell.size() * sizeof(std::uint32_t), cloud.list.size() * sizeof(std::uint16_t),
          cloud.record.size() * sizeof(LeafRecord),  cloud.low_res.size() * sizeof(LowResTexel),
          cloud.plane.size() * sizeof(Billboard),    sizeof(cloud.mask)};
}

}  // namespace sunfleck
