// Opacity maps of a forest for one light direction, or for several sample directions: each (prototype, local
// direction) is built once and shared by all instances that see the light from there.
#pragma once

#include <map>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "lighting/depth/opacity_map.h"
#include "lighting/depth/opacity_neighbours.h"
#include "sim/base/run_control.h"
#include "sim/forest/forest.h"

namespace sunfleck {

// Something to build a map for; `key` names the local direction.
struct MapWish {
  std::uint32_t prototype = 0;
  std::uint64_t key = 0;
  Vec3 to_light{0, 0, 1};  // tree frame
};

class MapTable {
 public:
  // Builds all wishes, equal ones once, in parallel.
  MapTable(const Forest& forest, const std::vector<MapWish>& wishes, int resolution,
           const RunControl& control, std::string_view stage);

  const OpacityMap& at(std::uint32_t prototype, std::uint64_t key) const {
    return *maps_[index_.at({prototype, key})];
  }
  std::size_t index(std::uint32_t prototype, std::uint64_t key) const { return index_.at({prototype, key}); }
  std::size_t size() const { return maps_.size(); }
  const OpacityMap& map(std::size_t i) const { return *maps_[i]; }
  std::uint32_t prototype(std::size_t i) const { return prototype_of_[i]; }
  const ElementRows& rows(std::uint32_t prototype) const { return rows_[prototype]; }

 private:
  std::map<std::pair<std::uint32_t, std::uint64_t>, std::size_t> index_;
  std::vector<std::unique_ptr<OpacityMap>> maps_;
  std::vector<std::uint32_t> prototype_of_;
  std::vector<ElementRows> rows_;  // by prototype
};

// Where coordinates of placed maps are counted from: the first instance's foot.
Vec3 forest_origin(const Forest& forest);
PlacedMap place_map(const Instance& instance, const OpacityMap& map, const Box& bounds_m, double yaw_rad,
                    const Vec3& origin_m);

}  // namespace sunfleck
