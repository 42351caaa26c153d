// single_scattering, spp, spp_g and spp_h: irradiance of every leaf from optical depth and thickness towards
// the sun and a few sample directions, by the simplified plane-parallel closed form, as [SPP] describes it.
//
// Two steps. prepare_spp() measures what depends on the forest alone; spp_light_map() with its result answers
// for any sun, sky, bands and optics. Keep the prepared part while the forest stays the same.
#pragma once

#include <cstdint>
#include <vector>

#include "lighting/base/light_map.h"
#include "lighting/optics/optics.h"
#include "lighting/sky/illumination.h"
#include "lighting/slab/canopy_angles.h"
#include "lighting/slab/cell_depths.h"
#include "lighting/slab/forest_grids.h"
#include "sim/base/run_control.h"
#include "sim/forest/forest.h"

namespace sunfleck {

enum class SppVariant {
  kSingleScattering,  // I0 alone: leaves receive attenuated sun and sky, and reflect or pass it on once
  kSpp,               // plane-parallel multiple scattering
  kSppG,              // the same with the geometric compensation factor, Eq. 28
  // The same slab lying on the ground, with the right mean cosine of diffuse light, the leaves' measured
  // angles and depths averaged over cells (spp_h.h): for closed canopies, see spp_h_suitability().
  kSppH
};

struct SppOptions {
  SppVariant variant = SppVariant::kSppG;
  int sample_directions = 22;  // 16 or 22, as in the paper
  int map_resolution = 64;     // texels of a prototype's opacity map along its longer side, 8 .. 1024
  int grid_resolution = 16;    // cells of an instance's low-resolution grid along its longest side, 2 .. 64
};

// What sun, sky, bands and optics have no say in. Memory: 4 bytes for each cell and 3/2 of the directions,
// for spp_g for twice the directions.
struct SppPrepared {
  SppOptions options;
  ForestGrids grids;
  CellDepths cells;
  std::vector<float> compensation;  // [axis][cell], spp_g only
  CanopyAngles angles;
};

// Throws Error(kInvalidInput) naming "spp.<option>"; Error(kCancelled).
SppPrepared prepare_spp(const Forest& forest, const SppOptions& options, const RunControl& control);

// `prepared` is of the same forest.
LightMap spp_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                       const SppPrepared& prepared, const RunControl& control);

// Both steps, leaving out of the first what this light does not need.
LightMap spp_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                       const SppOptions& options, const RunControl& control);

}  // namespace sunfleck
