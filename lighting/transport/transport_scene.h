// All that depends on the forest and the directions but not on a band: grid, cell contents, transmittances,
// sweep plans, sky and ground.
#pragma once

#include <memory>

#include "lighting/transport/cell_contents.h"
#include "lighting/transport/ground_map.h"
#include "lighting/transport/lanes.h"
#include "lighting/transport/sky_sectors.h"
#include "lighting/transport/sweep.h"

namespace sunfleck::transport {

struct TransportScene {
  DirectionSet set;
  DirectionLanes lanes;
  std::unique_ptr<BlockerField> field;
  CellContents contents;
  std::vector<SweepPlan> plans;      // per direction
  std::vector<float> transmittance;  // [half direction][cell]
  SkySectors sectors;
  std::unique_ptr<GroundMap> ground;
  bool periodic = false;

  std::size_t cells() const { return field->layout().cell_count(); }
  std::span<const float> transmittance_of(std::size_t direction) const {
    return {transmittance.data() + direction % set.half() * cells(), cells()};
  }
  std::span<float> part_of(std::vector<float>& radiance, std::size_t direction) const {
    return {radiance.data() + direction * cells(), cells()};
  }
};

TransportScene transport_scene(const Forest& forest, const ForestIndex& index, const Illumination& light,
                               int directions, double cell_m, const RunControl& control);

// Radiance of the sky that reaches each cell without meeting anything, for a diffuse irradiance of 1;
// [direction][cell].
std::vector<float> sky_radiance(const TransportScene& scene, const RunControl& control);

// Irradiance of every ground cell by `radiance`; where the way to the outside misses the grid, `outside` per
// direction.
std::vector<float> ground_irradiance(const TransportScene& scene, std::span<const float> radiance,
                                     std::span<const double> outside, const RunControl& control);

// Radiance that the ground sends into the grid from one direction.
class GroundInflow final : public Inflow {
 public:
  // `ground_radiance` per ground cell, `open_radiance` beyond the map.
  GroundInflow(const TransportScene& scene, std::size_t direction, std::span<const float> ground_radiance,
               float open_radiance);
  float radiance(const std::array<int, 3>& cell) const override;

 private:
  const TransportScene& scene_;
  std::span<const float> ground_radiance_;
  Vec3 towards_;
  float share_, open_radiance_;
  bool hits_map_;
};

}  // namespace sunfleck::transport
