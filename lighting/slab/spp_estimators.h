// single_scattering, spp, spp_g, spp_h and spp_marched: irradiance of every leaf from optical depth and
// thickness towards the sun and a few sample directions, by the simplified plane-parallel closed form, as
// [SPP] describes it.
//
// Two steps. prepare_spp() measures what depends on the forest alone; spp_light_map() with its result answers
// for any sun, sky, bands and optics. Keep the prepared part while the forest stays the same.
#pragma once

#include <cstdint>
#include <memory>
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

class BlockerField;

enum class SppVariant {
  kSingleScattering,  // I0 alone: leaves receive attenuated sun and sky, and reflect or pass it on once
  kSpp,               // plane-parallel multiple scattering
  kSppG,              // the same with the geometric compensation factor, Eq. 28
  // The same slab lying on the ground, with the right mean cosine of diffuse light, the leaves' measured
  // angles and depths averaged over cells (spp_h.h): for closed canopies, see spp_h_suitability().
  kSppH,
  kSppMarched  // depths marched leaf by leaf, refined form of scattered sunlight: spp_marched.h
};

// How leaves scatter along a line, for spp_marched.
enum class SppPhase {
  kIsotropic,  // as in [SPP] experiment 2
  kLeafAngles  // the mean over the prototype's real leaves, and their projected area along the line
};
// Where the lines end from which scattered light comes, for spp_marched.
enum class SppPaths {
  kSlab,         // at the border of the slab, as in [SPP] A.1
  kTrueBoundary  // where the marched depth in that direction ends, if that is nearer
};
struct SppMarchedOptions {
  SppPhase phase = SppPhase::kLeafAngles;
  SppPaths paths = SppPaths::kTrueBoundary;
  double cell_m = 0;  // of the leaf-area grid; 0: 2 to 4 leaf sides
};

struct SppOptions {
  SppVariant variant = SppVariant::kSppG;
  int sample_directions = 22;  // 16 or 22, as in the paper
  int map_resolution = 64;     // texels of a prototype's opacity map along its longer side, 8 .. 1024
  int grid_resolution = 16;    // cells of an instance's low-resolution grid along its longest side, 2 .. 64
  SppMarchedOptions marched;
};

// What sun, sky, bands and optics have no say in. Memory: 4 bytes for each cell and 3/2 of the directions,
// for spp_g for twice the directions.
struct SppPrepared {
  SppOptions options;
  ForestGrids grids;
  CellDepths cells;
  std::vector<float> compensation;  // [axis][cell], spp_g only
  CanopyAngles angles;
  std::shared_ptr<const BlockerField> blockers;  // spp_marched only
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
