// The opacity maps that a forest needs towards the sun, where they stand, and what they tell of the elements
// of their own prototype: the common part of the sun's depths by element and by cell.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lighting/slab/map_table.h"
#include "sim/base/run_control.h"

namespace sunfleck {

// The yaw an instance's map is made for.
class SunYaws {
 public:
  explicit SunYaws(const Forest& forest);
  double step_rad() const { return step_rad_; }
  double yaw_rad(const Instance& i) const;
  std::uint64_t key(const Instance& i) const;

 private:
  std::uint64_t step(const Instance& i) const;
  double base_rad_ = 0, step_rad_ = 0;
};

// Depths of a prototype's elements in its own map.
struct OwnDepths {
  std::vector<float> before, behind;
};

class SunMaps {
 public:
  // Maps share 1 GiB: their resolution is halved until they fit.
  SunMaps(const Forest& forest, const Vec3& to_sun, int map_resolution, const RunControl& control);
  SunMaps(const SunMaps&) = delete;
  SunMaps& operator=(const SunMaps&) = delete;

  int resolution() const { return resolution_; }
  double yaw_step_rad() const { return yaws_.step_rad(); }
  const MapTable& table() const { return *table_; }
  const std::vector<PlacedMap>& placed() const { return placed_; }
  const OpacityNeighbours& neighbours() const { return *neighbours_; }
  const OwnDepths& own(const Instance& i) const {
    return own_[table_->index(i.prototype.value, yaws_.key(i))];
  }
  // Per instance: <(n.s)^2> / <|n.s|> over its leaves.
  const std::vector<float>& turn_ratio() const { return turn_ratio_; }
  double coarsest_texel_m() const { return texel_m_; }

 private:
  SunYaws yaws_;
  int resolution_ = 0;
  double texel_m_ = 0;
  std::optional<MapTable> table_;
  std::vector<PlacedMap> placed_;
  std::vector<float> turn_ratio_;
  std::vector<OwnDepths> own_;
  std::optional<OpacityNeighbours> neighbours_;
};

}  // namespace sunfleck
