// All that depends on the forest, the directions and the cell size, but not on sun, sky or bands: grid, cell
// contents, transmittances, sweep plans and ground. And what depends on the sun's direction or the sky's
// shape alone.
#pragma once

#include "lighting/sky/illumination.h"
#include "lighting/transport/cell_contents.h"
#include "lighting/transport/lanes.h"
#include "lighting/transport/sweep_space.h"

namespace sunfleck::transport {

struct TransportScene : SweepSpace {
  DirectionLanes lanes;
  std::unique_ptr<BlockerField> field;
  CellContents contents;
  std::vector<float> transmittance;  // over half a step, [half direction][cell]

  std::span<const float> transmittance_of(std::size_t direction) const {
    return {transmittance.data() + direction % set.half() * cells(), cells()};
  }
};

// All but the ground. `index` is that of `forest`; `set` as from directions_for().
TransportScene transport_scene(const Forest& forest, const ForestIndex& index, DirectionSet set,
                               const BlockerFieldOptions& options, const RunControl& control);

// Radiance of the sky that reaches each cell without meeting anything, for a diffuse irradiance of 1;
// [direction][cell].
std::vector<float> sky_radiance(const TransportScene& scene, const SkySectors& sectors, CellValue value,
                                const RunControl& control);

}  // namespace sunfleck::transport
