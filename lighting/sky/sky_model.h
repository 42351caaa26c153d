// The sky models by name.
#pragma once

#include <string>

namespace sunfleck {

enum class SkyModel {
  kUniform,           // the same radiance from everywhere above the horizon
  kStandardOvercast,  // L = Lz (1 + 2 cos zenith) / 3, Moon and Spencer 1942
  kPerez              // all weathers, perez_sky.h; needs sun, clearness and brightness
};
std::string to_string(SkyModel model);  // "uniform", "standard_overcast", "perez"

// Radiance of the sky for a diffuse irradiance of 1 on a horizontal plane, 1/sr; 0 at and below the horizon.
// For the models that depend on the zenith angle alone; SkyRadiance (sky_radiance.h) serves all.
double relative_sky_radiance(SkyModel model, double cos_zenith);

}  // namespace sunfleck
