// Light on a plane with nothing in the way: what falls on the ground beyond the scene, and on a period.
#pragma once

#include "lighting/sky/illumination.h"

namespace sunfleck::trace {

// Irradiance of the side that `normal` (unit) points out of. The plane itself hides the sky behind it.
double open_irradiance_w_m2(const Illumination& light, const BandLight& band, const Vec3& normal);

}  // namespace sunfleck::trace
