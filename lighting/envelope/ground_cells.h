// The ground under and around the foliage as a coarse grid of Lambertian cells, and how much stands between
// each of them and the sky: what a leaf that looks down sees. Beyond the grid the ground counts as open.
#pragma once

#include <cstdint>
#include <vector>

#include "lighting/depth/extinction_grid.h"
#include "lighting/envelope/sector_set.h"

namespace sunfleck::envelope {

class GroundCells {
 public:
  static constexpr std::int32_t kOpen = -1;

  GroundCells() = default;
  GroundCells(const Forest& forest, const BlockerField& field);

  std::size_t count() const { return static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_); }
  Vec3 world_point(std::size_t cell) const;  // its middle
  Vec3 normal() const { return terrain_.normal(); }

  // The cell on the way from a point towards `towards`, both in the frame of the field; kOpen where the way
  // does not meet the ground of the grid.
  std::int32_t hit(const Vec3& point_m, const Vec3& towards) const;

 private:
  Vec3 field_point(std::size_t cell) const;

  Vec3 normal_{0, 0, 1}, point_m_{0};  // of the plane, in the frame of the field
  Vec3 world_from_field_m_{0};
  Terrain terrain_;
  Vec2 lo_m_{0}, cell_m_{1};
  int nx_ = 0, ny_ = 0;
  bool wraps_ = false;
};

}  // namespace sunfleck::envelope
