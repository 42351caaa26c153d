// Sunflecks on leaves without shadow rays: which points of a leaf lie in the sun, from the share of it that
// the light map says is sunlit and the rank tile of [LeafMask] (lighting/shade/shadow_tile.h).
//
// A point is lit where its rank in the tile is above a threshold of its leaf:
//   - where the map knows each leaf's own share (`reference`, `links`, `auto`): the rank above which that
//   share
//     of this leaf's points lies, so that the mean over the leaf is the stored share (to about 1/16, leaf by
//     leaf; without bias);
//   - where shares are smooth, exp(-depth) (`grid`, `world`, closed forms): 1 - share, so that the mean over
//     many leaves is right and leaves differ from each other as real ones do.
// Flecks have the size of real ones, in parallel light as large as leaves, but lie elsewhere: a picture is
// right in its means and its look, not shadow by shadow, and edges are a texel (an eighth of a leaf side)
// coarse. For leaves up to some 16 pixels wide. Shadows of trunks on a leaf are broken up into flecks. Where
// few leaves carry the whole picture, or the sun moves between pictures, trace.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "lighting/base/light_map.h"
#include "lighting/render/picture_scene.h"
#include "lighting/shade/shadow_tile.h"

namespace sunfleck {

// True if the map's sunlit shares are those of single leaves, by its method; also where that is not known.
bool knows_single_leaves(const LightMap& map);

// Const and safe from many threads.
class LeafFlecks {
 public:
  // `forest` is the one the map was computed for, `scene` how the picture shows it; they and the map must
  // outlive this. The map has a sunlit share per element.
  LeafFlecks(const Forest& forest, const PictureScene& scene, const LightMap& map, const Vec3& to_sun,
             const RunControl& control);

  // Whether the sun reaches the place of a foliage hit; `element` its number in the index. About 8 ns, and
  // 1 us for the first place of a leaf that is partly lit.
  bool lit(const RayHit& hit, std::size_t element) const;
  std::size_t memory_bytes() const;

 private:
  struct Sheet {
    ShadowTile tile;
    TileView view;
  };
  void make_sheets(const Forest& forest, const Vec3& to_sun, const RunControl& control);
  std::uint32_t find_patch(const RayHit& hit, std::size_t element) const;
  const TileView& view_of(const Instance& at) const { return sheets_[sheet_of_[at.prototype.value]].view; }

  const PictureScene& scene_;
  std::span<const float> share_;
  bool of_leaves_;
  float usual_threshold_ = 0.5f;
  std::vector<Sheet> sheets_;          // one per kind of foliage
  std::vector<std::size_t> sheet_of_;  // per prototype
  // Per element, found when first asked: 0 not yet; else the bits of the threshold, bit 1 set, bit 0 which of
  // two offsets. Two threads that ask at once find the same.
  mutable std::vector<std::atomic<std::uint32_t>> patch_;
};

}  // namespace sunfleck
