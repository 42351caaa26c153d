// Which of many points the sun sees, without rays: the points are sorted into the cells of the sun's view,
// then every figure is drawn once and asks the points below it (irregular z-buffer: Johnson, Lee, Burns and
// Mark 2005). Exact for each point, so there is no texel, no bias and no crack; a figure does not shade the
// points that lie on it, as a ray does not meet the surface it starts from. The disc of the sun is a number
// of directions; a point asks one of them.
#pragma once

#include <span>

#include "lighting/render/raster_trees.h"

namespace sunfleck {

struct SunPoint {
  float x_m = 0, y_m = 0, nearness_m = 0;  // in the sun's frame, px_per_unit 1
  std::uint32_t self = kSkyNumber;         // figure it lies on, by SunTrees' numbers; none for shoots
  std::uint32_t lot = 0;                   // for needles on the way
  std::uint32_t sample = 0;                // whose answer this is
};

// All trees as occluders. A periodic forest's points are brought into the base cell first (base_point).
class SunTrees {
 public:
  static constexpr std::int32_t kMostCells = 32;  // on each side of the base cell

  // `to_sun` of the disc's middle. Nothing where figures cannot be numbered or the sun is so low that copies
  // farther than kMostCells shade a periodic forest.
  static std::optional<SunTrees> make(const Forest& forest, const FigureTable& table, const Vec3& to_sun);

  // Frame of one direction: metres from the middle of the forest.
  RasterFrame frame(const Vec3& to_sun) const { return sun_frame(to_sun, middle_m_, Vec2(0.0), 1.0); }
  // Whether anything may lie between the sun and a point, for a quick no.
  bool may_shade(const Vec3& in_frame) const;
  // Number of a figure of an instance's copy in a cell, as seen from the base cell; kSkyNumber: not there.
  std::uint32_t number_of(std::uint32_t instance, const RasterCell& cell, std::uint32_t figure) const;
  const std::vector<PlacedFigures>& trees() const { return trees_; }
  std::uint64_t figures() const { return figures_; }

 private:
  Vec3 middle_m_{0};
  Box shade_;  // of the occluders in the frame of the middle direction, wider by the disc
  std::vector<PlacedFigures> trees_;
  std::vector<std::size_t> first_copy_;  // per instance into copies_
  struct Copy {
    RasterCell cell;
    std::uint32_t first_number;
  };
  std::vector<Copy> copies_;
  std::uint64_t figures_ = 0;
};

// Sets dark[sample] to 1 for each point that something lies between it and the sun. The points' order is of
// no matter.
void find_shade(const Forest& forest, const FigureTable& table, const SunTrees& trees, const Vec3& to_sun,
                std::span<const std::vector<SunPoint>* const> points, std::span<std::uint8_t> dark,
                const RunControl& control);

}  // namespace sunfleck
