// How the ground is lit through the canopy: sun and sky by what stands in their way, and what foliage throws
// down, a ground cell being a receiver like any leaf. What the ground gives back lights foliage that lights
// the ground: a few rounds, each cell for itself.
#pragma once

#include "lighting/envelope/envelope_sources.h"

namespace sunfleck::envelope {

// Fills ground_radiance of every band. Nothing to do where the ground is black or counts as fully lit.
void light_ground(Sources& sources, const PreparedParts& parts, const OpticsTable& optics,
                  PrototypeId foliage_above, const RunControl& control);

}  // namespace sunfleck::envelope
