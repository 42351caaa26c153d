// Opacity map of a prototype for one direction: optical depth along the direction from the lit side to any
// point, on a grid of texels across and slices along it. [SPP] section 5.1, there "deep opacity map".
//
// A leaf covers the share f = A |n.s| / texel^2 of its texel and lets 1 - f through: depth -log(1 - f). Where
// leaves lie independently of each other inside a texel the product of the shares let through is the mean gap
// exactly, for any texel; a plain sum of f is not once leaves are as large as texels. Wood is opaque: the
// shares of all wood in a texel and slice add up to the share it covers, at most to depth 8.
// It stops being true for leaves that avoid or seek each other within 1.5 leaf sides.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "lighting/depth/element_rows.h"
#include "lighting/depth/opacity_frame.h"
#include "sim/base/run_control.h"
#include "sim/plant/prototype.h"

namespace sunfleck {

// Optical depth from a point towards the light, and away from it to the far side.
struct OpticalDepths {
  double before = 0, behind = 0;
};

class OpacityMap {
 public:
  // `to_light` is a unit vector in the tree's frame; `resolution`: texels along the longer side, fewer where
  // they would be smaller than 1.5 leaf sides.
  OpacityMap(const Prototype& prototype, const Vec3& to_light, int resolution, const RunControl& control);

  // The same in vector code, `rows` those of the prototype: depths within 1e-5 of it, relative.
  OpacityMap(const Prototype& prototype, const ElementRows& rows, const Vec3& to_light, int resolution,
             const RunControl& control);

  // At a point in the tree's frame. Between texels transmissions are interpolated for `before`, depths for
  // `behind`.
  OpticalDepths at(const Vec3& point_m) const;
  // At the centre of an element of the prototype, without what the element itself contributes.
  OpticalDepths around(const FoliageElement& element) const;

  // around() of elements [begin, end), `rows` and results those of the prototype, in vector code: within 5e-6
  // of the depth of a leaf.
  void around_all(const Prototype& prototype, const ElementRows& rows, std::size_t begin, std::size_t end,
                  std::span<float> before, std::span<float> behind) const;

  // Adds at() of many points to `before` and `behind`: points are `map_from_points` away from the map's
  // texels and slices (texel_from_tree()). Single precision: within 1e-4 of a texel.
  void add_at(const AffineFloat& map_from_points, std::span<const float> x, std::span<const float> y,
              std::span<const float> z, std::span<float> before, std::span<float> behind) const;
  // Texel (0 at the middle of the first) and slice coordinates of a point in the tree's frame.
  Vec3 texel_from_tree(const Vec3& point_m) const;

  // Area-weighted means over the foliage of |n.s| (ecology's G-function) and of (n.s)^2.
  double leaf_projection() const { return leaf_projection_; }
  double mean_square_cosine() const { return mean_square_cosine_; }

  const OpacityLayout& layout() const { return layout_; }
  std::size_t memory_bytes() const { return cumulated_.size() * sizeof(float); }

 private:
  struct Share;
  template <class Visit>
  void for_each_share(const Vec3& centre, double area_m2, const Visit& visit) const;
  void add_foliage(const Prototype& prototype, const RunControl& control);
  void add_element(const FoliageElement& element);
  void add_rows(const Prototype& prototype, const ElementRows& rows, const RunControl& control);
  void add_wood(const Prototype& prototype, const RunControl& control);
  void cumulate(const RunControl& control);
  void measure_angles(const Prototype& prototype);
  void measure_angles(const Prototype& prototype, const ElementRows& rows);
  OpticalDepths read(const OpacitySite& site, const OpticalDepths* own) const;
  std::size_t row(std::size_t column) const { return column * (layout_.slices + 1); }

  OpacityLayout layout_;
  std::vector<float> cumulated_;  // [column][slice boundary], depth from the lit side
  double leaf_projection_ = 0.5, mean_square_cosine_ = 1.0 / 3.0;
};

// Bytes a map would take.
std::size_t opacity_map_bytes(const OpacityLayout& layout);
// And at most, whatever the prototype.
std::size_t largest_opacity_map_bytes(int resolution);

}  // namespace sunfleck
