// Skies and small stands for the tests of stand light.
#pragma once

#include <string>

#include "lighting/canopy/stand_light.h"
#include "lighting/sky/illumination.h"
#include "tests/lighting/trace/scenes.h"

namespace sunfleck::test {

// Patches of a sky, rings of equal height in cos(zenith); horizontal irradiance 1 in one interval "day".
LightSource sky_source(SkyModel model, int rings);
// Parallel light of 1 on a facing plane in one interval.
LightSource sun_source(const Vec3& to_sun, double strength = 1.0);
// No light in one interval.
LightSource dark_source();
StandSky stand_sky(LightSource sun, LightSource sky);

// Two by two metres, repeating, three trees of 300 leaves each and a stem; material optics .1 / .05 in "B".
Forest small_stand(bool periodic);

}  // namespace sunfleck::test
