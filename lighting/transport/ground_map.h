// The ground as a grid of Lambertian cells in a plane: which cell a ray from the leaf-area grid meets, and
// where rays from the ground enter the grid. Beyond the map the ground is lit as if nothing stood on it.
#pragma once

#include <cstdint>
#include <vector>

#include "lighting/depth/grid_frame.h"
#include "lighting/depth/grid_layout.h"
#include "lighting/transport/direction_set.h"
#include "sim/base/run_control.h"

namespace sunfleck::transport {

class GroundMap {
 public:
  static constexpr std::int32_t kOpen = -1;

  static constexpr int kUsualCellsPerSide = 96;

  // At most `cells_per_side` cells along a side, in a periodic scene one below every column of the grid.
  GroundMap(const Forest& forest, const GridFrame& frame, const GridLayout& layout, const DirectionSet& set,
            int cells_per_side, const RunControl& control);

  std::size_t count() const { return static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_); }
  double cell_area_m2() const;               // of the tilted plane
  Vec3 world_point(std::size_t cell) const;  // middle of a ground cell

  // Of a point in the frame of the field: where in the world it, or its copy in the base period, lies.
  Vec3 world_from_field(const Vec3& point_m) const;

  // Ground cell on the way from a point towards `towards` (both in the frame of the field), or behind it on
  // the same line where the point lies below the ground; kOpen beyond the map or for a level line.
  std::int32_t hit(const Vec3& point_m, const Vec3& towards) const;

  // Grid cell where the ray from a ground cell towards direction j of the set enters the grid; kOpen where it
  // misses it or does not rise above the ground.
  std::int32_t entry(std::size_t cell, std::size_t direction) const {
    return entries_[direction * count() + cell];
  }

 private:
  void choose_extent(const Forest& forest, const GridLayout& layout, int cells_per_side);
  Vec3 field_point(std::size_t cell) const;
  std::int32_t grid_entry(const Vec3& start_m, const Vec3& towards, const GridLayout& layout) const;

  Vec3 normal_{0, 0, 1}, point_m_{0};  // of the plane, in the frame of the field
  Vec3 world_from_field_m_{0};
  Terrain terrain_;
  Vec2 lo_m_{0}, cell_m_{1};
  int nx_ = 1, ny_ = 1;
  bool wraps_ = false;
  std::vector<std::int32_t> entries_;  // [direction][ground cell]
};

}  // namespace sunfleck::transport
