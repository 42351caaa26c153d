// The frame of an opacity map: a light direction as third axis, texels across it, slices along it.
#pragma once

#include <array>
#include <cstddef>

#include "lighting/depth/element_rows.h"
#include "sim/base/vec.h"
#include "sim/plant/prototype.h"

namespace sunfleck {

// Unit axes: `across` is horizontal (x for a vertical light), `upwards` completes (across, upwards,
// to_light).
inline constexpr int kOpacityMargin = 2;  // texels around the bounds
inline constexpr int kMostOpacitySlices = 256;

struct LightAxes {
  Vec3 across, upwards, to_light;
};
LightAxes light_axes(const Vec3& to_light);

// Coordinates of p along the three axes.
inline Vec3 along(const LightAxes& axes, const Vec3& p) {
  return {glm::dot(axes.across, p), glm::dot(axes.upwards, p), glm::dot(axes.to_light, p)};
}

// Box around foliage and wood in coordinates along the axes; empty for a prototype without either.
Box projected_bounds(const Prototype& prototype, const LightAxes& axes);

// Side of a leaf, area-weighted over the foliage: sqrt(sum A^2 / sum A) of projected-size areas, m; 0 without
// foliage.
double typical_leaf_side_m(const Prototype& prototype);

// Where a point falls in the grid of texels and slices: four columns with bilinear weights, one slice and the
// part of it that lies between its lit side and the point.
struct OpacitySite {
  std::array<std::size_t, 4> column{};
  std::array<double, 4> weight{};
  std::size_t slice = 0;
  double part = 0;  // [0, 1]
};

struct OpacityLayout {
  LightAxes axes;
  Vec2 corner{0};         // of the texels, along across and upwards
  double lit_side_m = 0;  // coordinate along to_light at which depth begins
  double texel_m = 1, slice_m = 1;
  std::size_t texels_across = 0, texels_upwards = 0, slices = 0;  // all 0: nothing there

  std::size_t columns() const { return texels_across * texels_upwards; }
  // False if the point is beside the grid; points before or behind it belong to its first or last slice.
  bool locate(const Vec3& point, OpacitySite& site) const;
};

// Texels of at least 1.5 leaf sides: below that a texel sees single leaves, and their number no mean depth.
OpacityLayout opacity_layout(const Prototype& prototype, const Vec3& to_light, int resolution);
// The same in vector code; `rows` are the prototype's.
OpacityLayout opacity_layout(const Prototype& prototype, const ElementRows& rows, const Vec3& to_light,
                             int resolution);

}  // namespace sunfleck
