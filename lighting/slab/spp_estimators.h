// single_scattering, spp and spp_g: irradiance of every leaf from optical depth and thickness towards the sun
// and a few sample directions, by the simplified plane-parallel closed form, as [SPP] describes it.
#pragma once

#include <cstdint>

#include "lighting/base/light_map.h"
#include "lighting/optics/optics.h"
#include "lighting/sky/illumination.h"
#include "sim/base/run_control.h"
#include "sim/forest/forest.h"

namespace sunfleck {

enum class SppVariant {
  kSingleScattering,  // I0 alone: leaves receive attenuated sun and sky, and reflect or pass it on once
  kSpp,               // plane-parallel multiple scattering
  kSppG               // the same with the geometric compensation factor, Eq. 28
};

struct SppOptions {
  SppVariant variant = SppVariant::kSppG;
  int sample_directions = 22;  // 16 or 22, as in the paper
  int map_resolution = 64;     // texels of a prototype's opacity map along its longer side, 8 .. 1024
  int grid_resolution = 16;    // cells of an instance's low-resolution grid along its longest side, 2 .. 64
};

LightMap spp_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                       const SppOptions& options, const RunControl& control);

}  // namespace sunfleck
