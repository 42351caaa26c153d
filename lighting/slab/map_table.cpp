// Shared opacity maps; see map_table.h.
#include "lighting/slab/map_table.h"

#include <cmath>

#include "sim/base/parallel.h"

namespace sunfleck {

MapTable::MapTable(const Forest& forest, const std::vector<MapWish>& wishes, int resolution,
                   const RunControl& control, std::string_view stage) {
  std::vector<Vec3> direction;
  for (const MapWish& wish : wishes)
    if (index_.try_emplace({wish.prototype, wish.key}, prototype_of_.size()).second) {
      prototype_of_.push_back(wish.prototype);
      direction.push_back(wish.to_light);
    }
  for (const Prototype& p : forest.prototypes) rows_.push_back(element_rows(p));
  maps_.resize(prototype_of_.size());
  for_each_chunk(maps_.size(), 1, control, stage, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      maps_[i] = std::make_unique<OpacityMap>(forest.prototypes[prototype_of_[i]], rows_[prototype_of_[i]],
                                              direction[i], resolution, RunControl{control.stop, {}});
  });
}

Vec3 forest_origin(const Forest& forest) {
  return forest.instances.empty() ? Vec3(0.0) : forest.instances.front().position_m;
}

PlacedMap place_map(const Instance& instance, const OpacityMap& map, const Box& bounds_m, double yaw_rad,
                    const Vec3& origin_m) {
  return {&map,
          instance.position_m - origin_m,
          std::cos(yaw_rad),
          std::sin(yaw_rad),
          static_cast<double>(instance.scale),
          bounds_m};
}

}  // namespace sunfleck
