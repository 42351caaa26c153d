#include "lighting/shade/shadow_tile.h"

#include <bit>
#include <limits>
#include <numeric>

#include "sim/base/contract.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

// Optical depth of the leaves scattered: one texel in 400 sees none of them and ranks last.
constexpr double kTileDepth = 6;

void check(const ShadowTileOptions& o) {
  if (o.side < 64 || o.side > 4096 || !std::has_single_bit(static_cast<unsigned>(o.side)))
    throw_invalid("shadow tile side", std::to_string(o.side), "a power of two from 64 to 4096");
  if (!(o.texels_per_leaf > 0 && o.texels_per_leaf <= o.side / 4.0))
    throw_invalid("shadow tile texels_per_leaf", std::to_string(o.texels_per_leaf),
                  "above 0 and at most a quarter of the side");
}

// Distances seen from the sun, texel by texel.
struct DepthPicture {
  int side = 0;
  double texel_m = 0;
  std::vector<float> depth;

  float& at(int column, int row) {
    const int mask = side - 1;
    return depth[static_cast<std::size_t>(row & mask) * static_cast<std::size_t>(side) +
                 static_cast<std::size_t>(column & mask)];
  }
};

// Draws the leaf's outline across z, wrapped round the edges, keeping the smallest depth.
void draw_leaf(DepthPicture& picture, const PlacedLeaf& leaf, RandomStream& random) {
  const double determinant = leaf.half_u.x * leaf.half_v.y - leaf.half_u.y * leaf.half_v.x;
  if (std::abs(determinant) < 1e-12 * picture.texel_m * picture.texel_m) return;  // edge on
  const double reach_x = std::abs(leaf.half_u.x) + std::abs(leaf.half_v.x);
  const double reach_y = std::abs(leaf.half_u.y) + std::abs(leaf.half_v.y);
  const int x0 = static_cast<int>(std::floor((leaf.centre.x - reach_x) / picture.texel_m));
  const int x1 = static_cast<int>(std::ceil((leaf.centre.x + reach_x) / picture.texel_m));
  const int y0 = static_cast<int>(std::floor((leaf.centre.y - reach_y) / picture.texel_m));
  const int y1 = static_cast<int>(std::ceil((leaf.centre.y + reach_y) / picture.texel_m));
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const double dx = (x + 0.5) * picture.texel_m - leaf.centre.x;
      const double dy = (y + 0.5) * picture.texel_m - leaf.centre.y;
      const double a = (dx * leaf.half_v.y - dy * leaf.half_v.x) / determinant;
      const double b = (dy * leaf.half_u.x - dx * leaf.half_u.y) / determinant;
      if (!leaf_covers(leaf.shape, a, b)) continue;
      if (leaf.cover < 1 && random.uniform() >= leaf.cover) continue;
      float& depth = picture.at(x, y);
      depth = std::min(depth, static_cast<float>(leaf.centre.z + a * leaf.half_u.z + b * leaf.half_v.z));
    }
}

// Every texel's place in the order of depths, ties (texels without a leaf) in an order by lot, in 65536ths.
std::vector<std::uint16_t> ranks_of(const DepthPicture& picture, std::uint64_t seed) {
  const std::size_t count = picture.depth.size();
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (picture.depth[a] != picture.depth[b]) return picture.depth[a] < picture.depth[b];
    return mix_seed(seed, a) < mix_seed(seed, b);
  });
  std::vector<std::uint16_t> rank(count);
  for (std::size_t i = 0; i < count; ++i) rank[order[i]] = static_cast<std::uint16_t>(i * 65536 / count);
  return rank;
}

}  // namespace

ShadowTile build_shadow_tile(const MaskLeaves& leaves, const ShadowTileOptions& options,
                             const RunControl& control) {
  check(options);
  ShadowTile tile;
  tile.side = options.side;
  tile.width_m = options.side / options.texels_per_leaf * leaves.side_m();
  DepthPicture picture{options.side, tile.width_m / options.side, {}};
  picture.depth.assign(static_cast<std::size_t>(options.side) * static_cast<std::size_t>(options.side),
                       std::numeric_limits<float>::infinity());
  // Leaves turned every way cover half their area on average.
  const double count = kTileDepth * tile.width_m * tile.width_m / (0.5 * leaves.mean_cover_m2);
  const double deep_m = kTileDepth / leaves.extinction_per_m();
  RandomStream random(options.seed, 0, RandomPurpose::kShadowMask);
  for (std::int64_t i = 0; i < std::llround(count); ++i) {
    if (i % 1024 == 0) control.check();
    const Vec3 centre(random.uniform(0, tile.width_m), random.uniform(0, tile.width_m),
                      random.uniform(0, deep_m));
    draw_leaf(picture, place_leaf(leaves, centre, random), random);
  }
  tile.rank = ranks_of(picture, options.seed);
  return tile;
}

TileView view_tile(const ShadowTile& tile, const Vec3& to_light) {
  SUNFLECK_EXPECTS(tile.side > 0);
  const Basis basis = basis_around(to_light);
  const double texels_per_m = tile.side / tile.width_m;
  const auto side = static_cast<unsigned>(tile.side);
  return {texels_per_m * basis.tangent, texels_per_m * basis.bitangent, tile.rank.data(), side - 1,
          static_cast<std::uint32_t>(std::countr_zero(side))};
}

void tile_lit_points(const TileView& view, std::span<const Vec3> points, std::span<const float> transmittance,
                     std::span<std::uint8_t> lit) {
  SUNFLECK_EXPECTS(points.size() == transmittance.size() && points.size() == lit.size());
  for (std::size_t i = 0; i < points.size(); ++i) lit[i] = tile_lit(view, points[i], transmittance[i]);
}

}  // namespace sunfleck
