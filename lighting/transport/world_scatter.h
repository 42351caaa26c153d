// What the content of a world cell makes of the light in it: the innermost step of the world grid, in a plain
// form and in one for machines with AVX-512.
#pragma once

#include <span>

#include "lighting/transport/world_kernels.h"
#include "lighting/transport/world_scene.h"

namespace sunfleck::transport {

// Adds to `source` what a cell's entries give off towards every direction for the radiance in it and the
// sun's irradiance on a plane that faces it.
using ScatterCell = void (*)(std::span<const WorldEntry> entries, const KindKernel* kernels,
                             const BothLanes& radiance, float sun_w_m2, BothLanes& source);

void scatter_cell_plain(std::span<const WorldEntry> entries, const KindKernel* kernels,
                        const BothLanes& radiance, float sun_w_m2, BothLanes& source);

// The fastest form this machine runs. All agree but for rounding.
ScatterCell scatter_cell_best();

}  // namespace sunfleck::transport
