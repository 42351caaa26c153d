// One tile of the sun's picture: draws what touches it, then counts for every element its pixels, those the
// sun sees, and the borders of shade between them. Counts are integers in steps of 1 / kWhole, so that tiles
// add up the same in any order.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lighting/trace/raster_cloud.h"
#include "lighting/trace/raster_shapes.h"

namespace sunfleck::trace {

inline constexpr std::int32_t kTileSide = 128;
inline constexpr double kWhole = 1 << 20;

// Over all tiles of one picture, per element, in 1 / kWhole.
struct SunTally {
  std::uint64_t covered = 0;  // pixels; of a shoot: way through its cloud, in lengths of its longest chord
  std::uint64_t visible = 0;  // of them seen by the sun, or their mean transmittance
  // Of a leaf: neighbouring pixels of it of which the sun sees one alone (squared difference of their
  // transmittances). Of a shoot: covered * (mean transmittance)^2.
  std::uint64_t borders = 0;
};

// What a tile found out about an element that may cover no pixel: at one random point of it, whether the
// nearest pixel shows something above (0 to 1).
struct SunLookup {
  std::uint32_t element;
  float transmittance;
};

class RasterTile {
 public:
  // `box` at most kTileSide wide and high.
  RasterTile(const RasterView& view, const RasterScene& scene, const PixelBox& box);

  // `records` of the scene that may touch the tile, in rising order; adds to `tallies` atomically.
  void work(std::span<const std::uint32_t> records, std::uint64_t seed, std::vector<SunTally>& tallies,
            std::vector<SunLookup>& lookups);

 private:
  struct Fragment {
    std::uint32_t pixel, record;
    float enter, leave;  // depths; leave is nearer to the sun
    bool question;       // a look-up: shades nothing
  };

  std::size_t at(std::int32_t u, std::int32_t v) const {
    return static_cast<std::size_t>(v - box_.v_lo) * kTileSide + static_cast<std::size_t>(u - box_.u_lo);
  }
  void clear();
  void draw(std::uint32_t record);
  void draw_flat(std::uint32_t record);
  void draw_cone(std::uint32_t record);
  void gather_shoot(std::uint32_t record, SunTally& tally);
  void look_up(std::span<const std::uint32_t> records, std::uint64_t seed, std::vector<SunLookup>& lookups);
  void pass_through_shoots(std::vector<SunTally>& tallies, std::vector<SunLookup>& lookups);
  void pass_pixel(std::span<const Fragment> fragments, std::vector<SunTally>& tallies,
                  std::vector<SunLookup>& lookups);
  SunTally count_opaque(std::uint32_t record) const;
  SunTally count_behind_shoots(std::uint32_t record) const;
  // Where in the tile a record's random point falls and at what depth; false if elsewhere.
  bool find_point(const RasterRecord& record, std::uint64_t seed, std::uint32_t& pixel, float& depth) const;

  double own_shade(const RasterRecord& record) const;

  const RasterView& view_;
  const RasterScene& scene_;
  const PixelBox box_;
  std::vector<float> depth_;
  std::vector<std::uint32_t> shown_;   // record of the nearest surface
  std::vector<float> transmittance_;  // down to it; empty without shoots
  std::vector<Fragment> fragments_;
  CloudLine line_;
};

}  // namespace sunfleck::trace
