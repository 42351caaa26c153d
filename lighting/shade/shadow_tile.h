// Which points of far leaves lie in the sun, without a ray: a periodic picture of leaves seen from the sun in
// which every texel knows its rank among all, from the nearest leaf to the farthest. A point whose share of
// sunlight is T (exp of minus the optical depth towards the sun) is lit where rank > 1 - T. So the mean over
// the tile is T exactly, for any density or clumping, and darker where T is smaller.
//
// This is the orthographic form of the shadow masks of [LeafMask]: their cube maps of distances (cube_mask.h)
// give the wrong mean (one realisation, one direction) and shadows of the wrong size. Parallel light throws
// shadows as large as their leaves, so the tile is read across the light: two floors and one load, about 4
// ns.
//
// Use: far leaves (below about 2 pixels) in pictures. Not for light maps: there T itself is the right value
// and a mask only adds noise. Limits: shadows slide as the sun moves; neighbouring leaves are not those of
// the real tree; the optical depth must count every tree in the way.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "lighting/shade/mask_leaves.h"
#include "sim/base/run_control.h"

namespace sunfleck {

struct ShadowTile {
  int side = 0;                     // texels, a power of two
  double width_m = 0;               // of the tile
  std::vector<std::uint16_t> rank;  // [row][column], 65536ths

  std::size_t memory_bytes() const { return rank.size() * sizeof(std::uint16_t); }
};

struct ShadowTileOptions {
  int side = 256;              // texels: 64 .. 4096, a power of two
  double texels_per_leaf = 8;  // per side of a square of the mean leaf area: (0, side / 4]
  std::uint64_t seed = 1;
};
// Throws Error(kInvalidInput) for options out of range. Same bytes for any number of threads.
ShadowTile build_shadow_tile(const MaskLeaves& leaves, const ShadowTileOptions& options,
                             const RunControl& control = {});

// The tile seen along one light direction.
struct TileView {
  Vec3 across{0}, up{0};  // texels per metre
  const std::uint16_t* rank = nullptr;
  std::uint32_t mask = 0, shift = 0;  // side - 1, log2(side)
};
TileView view_tile(const ShadowTile& tile, const Vec3& to_light);

// Offset that moves each leaf to another part of the tile: for trees wider than the tile, where its period
// would show. 0 keeps world coordinates: a deeper point on one light ray is then never brighter.
inline std::uint32_t leaf_offset(std::uint32_t leaf) {
  std::uint32_t h = leaf * 0x9E3779B1u;
  h ^= h >> 15;
  return h * 0x85EBCA77u;
}

// Rank of a point in (0, 1); texels are nearest.
inline float tile_rank(const TileView& view, const Vec3& point, std::uint32_t offset = 0) {
  const auto x =
      static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(glm::dot(point, view.across))));
  const auto y = static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(glm::dot(point, view.up))));
  const std::uint32_t column = (x + (offset & 0xFFFFu)) & view.mask, row = (y + (offset >> 16)) & view.mask;
  return (static_cast<float>(view.rank[(row << view.shift) + column]) + 0.5f) * (1.0f / 65536);
}

// The same between texel centres by bilinear mixture: smooth edges, but no longer evenly spread over (0, 1),
// for who finds thresholds by quantiles.
inline float tile_rank_between(const TileView& view, const Vec3& point, std::uint32_t offset = 0) {
  const double x = glm::dot(point, view.across), y = glm::dot(point, view.up);
  const double column = std::floor(x), row = std::floor(y);
  const auto fx = static_cast<float>(x - column), fy = static_cast<float>(y - row);
  const std::uint32_t c = static_cast<std::uint32_t>(static_cast<std::int64_t>(column)) + (offset & 0xFFFFu);
  const std::uint32_t r = static_cast<std::uint32_t>(static_cast<std::int64_t>(row)) + (offset >> 16);
  const auto at = [&](std::uint32_t dx, std::uint32_t dy) {
    return static_cast<float>(view.rank[(((r + dy) & view.mask) << view.shift) + ((c + dx) & view.mask)]);
  };
  const float low = at(0, 0) + fx * (at(1, 0) - at(0, 0)), high = at(0, 1) + fx * (at(1, 1) - at(0, 1));
  return (low + fy * (high - low) + 0.5f) * (1.0f / 65536);
}

// True if the point gets the sun, given its share of sunlight T in [0, 1].
inline bool tile_lit(const TileView& view, const Vec3& point, float transmittance, std::uint32_t offset = 0) {
  return tile_rank(view, point, offset) > 1 - transmittance;
}

// Share of the sun's disc that a point sees, softened by half width `softness` in rank. The ramp is narrowed
// to min(T, 1 - T), which keeps the mean at T.
inline float tile_lit_share(const TileView& view, const Vec3& point, float transmittance, float softness,
                            std::uint32_t offset = 0) {
  const float width = std::max(1e-6f, std::min(softness, std::min(transmittance, 1 - transmittance)));
  return std::clamp((tile_rank(view, point, offset) - (1 - transmittance)) / (2 * width) + 0.5f, 0.0f, 1.0f);
}

// Many points at once. Sizes equal; `lit` is 0 or 1.
void tile_lit_points(const TileView& view, std::span<const Vec3> points, std::span<const float> transmittance,
                     std::span<std::uint8_t> lit);

}  // namespace sunfleck
