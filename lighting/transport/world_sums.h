// What the world's trees, wood and ground make of the light in a band.
#pragma once

#include "lighting/transport/world_solver.h"

namespace sunfleck::transport {

// Radiance in a cell, the half set's directions and their opposites.
inline BothLanes radiance_in(const WorldScene& scene, const std::vector<float>& radiance, std::size_t cell) {
  BothLanes lanes{};
  const std::size_t half = scene.set.half(), cells = scene.cells();
  for (std::size_t j = 0; j < half; ++j) {
    lanes[j] = radiance[j * cells + cell];
    lanes[kLanes + j] = radiance[(half + j) * cells + cell];
  }
  return lanes;
}

// Fills `trees`, `mean_irradiance_w_m2` and, in a periodic scene, `budget`, from the radiance and the
// ground's irradiance in `band`.
void add_sums(const WorldScene& scene, const Forest& forest, const WorldSources& sources,
              const BandLight& strength, double soil_albedo, WorldBand& band, const RunControl& control);

}  // namespace sunfleck::transport
