// What each tree would intercept alone in the open: rays go through the whole stand, and every tree that is
// met anywhere on the way counts once per ray (in a periodic forest every copy of it for itself).
#pragma once

#include "lighting/canopy/first_light.h"

namespace sunfleck {

// m2 of facing light per instance, leaves and wood. `rays_on_map` of `options` as in drop_light(); every tree
// gets the counts of all rays, so that far fewer rays than there are needed.
ResponseTable crown_potential(const StandScene& scene, const LightSource& source, const DropOptions& options,
                              const RunControl& control);

}  // namespace sunfleck
