#include "lighting/shade/billboard_cloud.h"

#include <algorithm>
#include <cmath>

#include "lighting/shade/mask_leaves.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

constexpr int kCellSamples = 16;  // per side, to see which leaves a cell holds
constexpr std::size_t kMostEntries = (1u << 24) - 1, kMostRecords = 65535, kMostPerCell = 255;

// A leaf on its plane.
struct FlatLeaf {
  Vec2 centre{0}, half_u{0}, half_v{0};
  double height = 0;  // over the plane, of the centre
  Vec2 rise{0};       // of the leaf's own plane, per metre
  Vec3 normal{0};     // of the leaf, on the side of the plane's normal
  ElementShape shape = ElementShape::kParallelogram;
};

// The two axes on a plane along which its leaves spread most and least.
Basis spread_axes(std::span<const FoliageElement> foliage, const LeafPlane& plane) {
  const Basis any = basis_around(plane.normal);
  double xx = 0, xy = 0, yy = 0;
  for (const std::uint32_t i : plane.leaves) {
    const Vec3 off = Vec3(foliage[i].centre_m) - plane.centre;
    const double x = glm::dot(off, any.tangent), y = glm::dot(off, any.bitangent);
    xx += x * x, xy += x * y, yy += y * y;
  }
  const double turn = 0.5 * std::atan2(2 * xy, xx - yy);
  const Vec3 u = std::cos(turn) * any.tangent + std::sin(turn) * any.bitangent;
  return {u, glm::cross(plane.normal, u)};
}

// Smallest rotation that lays `normal` onto the plane's (either side), applied to v.
Vec3 turned_into(const Vec3& v, const Vec3& normal, const Vec3& onto) {
  const Vec3 axis = glm::cross(normal, onto);
  const double cosine = glm::dot(normal, onto);
  return v * cosine + glm::cross(axis, v) + axis * (glm::dot(axis, v) / (1 + cosine));
}

FlatLeaf flat_leaf(const FoliageElement& e, const LeafPlane& plane, const Basis& axes, bool turn) {
  FlatLeaf flat;
  Vec3 u(e.half_u_m), v(e.half_v_m);
  const Vec3 across = glm::cross(u, v), centre = Vec3(e.centre_m) - plane.centre;
  flat.normal = glm::length(across) > 0 ? glm::normalize(across) : plane.normal;
  if (glm::dot(flat.normal, plane.normal) < 0) flat.normal = -flat.normal;
  flat.height = glm::dot(centre, plane.normal);
  if (turn) {
    u = turned_into(u, flat.normal, plane.normal);
    v = turned_into(v, flat.normal, plane.normal);
  } else if (const double lift = glm::dot(flat.normal, plane.normal); lift > 0.05) {
    flat.rise = -Vec2(glm::dot(flat.normal, axes.tangent), glm::dot(flat.normal, axes.bitangent)) / lift;
  }
  flat.centre = {glm::dot(centre, axes.tangent), glm::dot(centre, axes.bitangent)};
  flat.half_u = {glm::dot(u, axes.tangent), glm::dot(u, axes.bitangent)};
  flat.half_v = {glm::dot(v, axes.tangent), glm::dot(v, axes.bitangent)};
  flat.shape = e.shape;
  return flat;
}

struct Bounds2 {
  Vec2 lo{1e300}, hi{-1e300};
  void include(const Vec2& p) { lo = glm::min(lo, p), hi = glm::max(hi, p); }
};

Bounds2 bounds_of(const FlatLeaf& leaf) {
  const Vec2 reach = glm::abs(leaf.half_u) + glm::abs(leaf.half_v);
  return {leaf.centre - reach, leaf.centre + reach};
}

bool covers(const FlatLeaf& leaf, const LeafMask& mask, const Vec2& p) {
  const double determinant = leaf.half_u.x * leaf.half_v.y - leaf.half_u.y * leaf.half_v.x;
  if (determinant == 0) return false;
  const Vec2 d = p - leaf.centre;
  return mask.covers((d.x * leaf.half_v.y - d.y * leaf.half_v.x) / determinant,
                     (leaf.half_u.x * d.y - leaf.half_u.y * d.x) / determinant);
}

std::int16_t packed_edge(double edge_m, double scale_m) {
  return static_cast<std::int16_t>(std::lround(std::clamp(edge_m / scale_m, -1.0, 1.0) * 32767));
}

LeafRecord packed(const FlatLeaf& leaf, const Billboard& board, const Vec2& corner, double scale_m,
                  const std::array<float, 4>& ambient) {
  const auto place = [](double at, double size) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(at / size, 0.0, 1.0) * 65535));
  };
  LeafRecord record;
  record.position = {place(leaf.centre.x - corner.x, board.width_m),
                     place(leaf.centre.y - corner.y, board.height_m)};
  record.edges = {packed_edge(leaf.half_u.x, scale_m), packed_edge(leaf.half_u.y, scale_m),
                  packed_edge(leaf.half_v.x, scale_m), packed_edge(leaf.half_v.y, scale_m)};
  record.type_and_ambient = static_cast<std::uint32_t>(leaf.shape);
  for (int k = 0; k < 4; ++k)
    record.type_and_ambient |=
        static_cast<std::uint32_t>(std::lround(std::clamp(ambient[k], 0.0f, 1.0f) * 63.0f)) << (8 + 6 * k);
  return record;
}

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
               static_cast<std::uint16_t>(k));
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

BillboardCloud build_billboard_cloud(const Prototype& prototype, const BillboardOptions& options,
                                     std::span<const std::array<float, 4>> ambient,
                                     const RunControl& control) {
  if (!(options.cell_half_edges >= 1 && options.cell_half_edges <= 64))
    throw_invalid("billboard cells", std::to_string(options.cell_half_edges), "1 to 64 half edges of a leaf");
  if (!ambient.empty() && ambient.size() != prototype.foliage.size())
    throw_invalid("billboard ambient", std::to_string(ambient.size()) + " leaves",
                  "as many as the foliage has");
  const std::vector<LeafPlane> planes = cluster_leaves(prototype.foliage, options.clusters, control);
  BillboardCloud cloud;
  cloud.low_res_only = options.low_res_only;
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

std::array<double, 4> fit_corner_ambient(std::span<const AmbientPoint> points) {
  SUNFLECK_EXPECTS(!points.empty());
  double mean = 0;
  for (const AmbientPoint& p : points) mean += p.value / static_cast<double>(points.size());
  // Normal equations for what each corner differs from the mean, with a slight pull to it.
  std::array<std::array<double, 5>, 4> m{};
  for (std::size_t k = 0; k < 4; ++k) m[k][k] = 1e-6;
  for (const AmbientPoint& p : points) {
    const std::array<double, 4> w{(1 - p.a) * (1 - p.b) / 4, (1 + p.a) * (1 - p.b) / 4,
                                  (1 - p.a) * (1 + p.b) / 4, (1 + p.a) * (1 + p.b) / 4};
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) m[i][j] += w[i] * w[j];
      m[i][4] += w[i] * (p.value - mean);
    }
  }
  for (std::size_t i = 0; i < 4; ++i)  // positive definite: no pivoting
    for (std::size_t row = i + 1; row < 4; ++row) {
      const double factor = m[row][i] / m[i][i];
      for (std::size_t column = i; column < 5; ++column) m[row][column] -= factor * m[i][column];
    }
  std::array<double, 4> corner{};
  for (std::size_t i = 4; i-- > 0;) {
    double rest = m[i][4];
    for (std::size_t j = i + 1; j < 4; ++j) rest -= m[i][j] * corner[j];
    corner[i] = rest / m[i][i];
  }
  for (double& value : corner) value += mean;
  return corner;
}

}  // namespace sunfleck
