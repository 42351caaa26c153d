// Optical depth through a forest as the sum over the instances a line can meet, each read from the opacity
// map of its prototype ([SPP] Eq. 31, with yaw and scale). Flat or tilted ground ends every line downwards;
// as the instances stand on it, nothing beyond it is counted.
//
// Which instances can meet a line is found once per instance, in the plane across the light: rectangles
// around the instances in buckets, so the work grows with the instances times the overlap of their
// rectangles. Copies of a periodic forest are rectangles like others, as far away as the forest is high
// enough for the light.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "lighting/depth/opacity_map.h"
#include "sim/forest/forest.h"

namespace sunfleck {

// The map of an instance where it stands. The map's direction is the light's, turned into the tree's frame.
struct PlacedMap {
  const OpacityMap* map = nullptr;
  Vec3 foot_m{0};  // relative to the origin of the table
  double cos_yaw = 1, sin_yaw = 0;
  double scale = 1;
  Box bounds_m;  // of the prototype, in the tree's frame

  Vec3 tree_from_world(const Vec3& p) const {
    const Vec3 d = (p - foot_m) / scale;
    return {cos_yaw * d.x + sin_yaw * d.y, cos_yaw * d.y - sin_yaw * d.x, d.z};
  }
  Vec3 world_from_tree(const Vec3& p) const {
    return foot_m + scale * Vec3(cos_yaw * p.x - sin_yaw * p.y, sin_yaw * p.x + cos_yaw * p.y, p.z);
  }
};

// An instance, or a copy of one, that a line through another can meet.
struct Neighbour {
  std::uint32_t placed = 0;
  Vec3 shift_m{0};    // of the copy
  Vec2 lo{0}, hi{0};  // rectangle across the light
};

// How far a periodic forest repeats for a light direction.
struct CopyReach {
  int copies_x = 0, copies_y = 0;  // on each side
  bool complete = true;            // false: the light is so low that farther copies are left out
};
CopyReach copy_reach(const Forest& forest, const Box& bounds_m, const Vec3& to_light);

class OpacityNeighbours {
 public:
  // `placed` must outlive it: one per instance of the forest, in their order.
  OpacityNeighbours(const Forest& forest, std::span<const PlacedMap> placed, const Vec3& to_light);

  // All whose rectangles overlap that of the instance, in fixed order, the instance itself left out.
  std::vector<Neighbour> around(std::size_t instance) const;
  // Sum over them at a point relative to the table's origin.
  OpticalDepths at(std::span<const Neighbour> neighbours, const Vec3& point_m) const;
  // Adds the same sums for many points in the frame of `own`, one of the placed, as it stands.
  void add_at(std::span<const Neighbour> neighbours, const PlacedMap& own, std::span<const float> x,
              std::span<const float> y, std::span<const float> z, std::span<float> before,
              std::span<float> behind) const;
  bool complete() const { return reach_.complete; }

 private:
  struct Rectangle {
    Vec2 lo{0}, hi{0};
  };
  Rectangle rectangle_of(const PlacedMap& placed) const;
  void add_copies(const Forest& forest, std::span<const Rectangle> own);
  void fill_buckets();
  template <class Visit>
  void for_each_bucket(const Vec2& lo, const Vec2& hi, const Visit& visit) const;

  std::span<const PlacedMap> placed_;
  LightAxes axes_;
  CopyReach reach_;
  Rectangle all_;
  std::vector<Rectangle> own_;
  std::vector<Neighbour> entries_;  // originals first, in instance order
  std::size_t side_ = 1;            // buckets along each side
  std::vector<std::uint32_t> bucket_first_, bucket_entries_;
};

}  // namespace sunfleck
