// Virtual hemispherical photographs as files that programs for real ones read.
#pragma once

#include <filesystem>

#include "lighting/canopy/sensor_canopy.h"

namespace sunfleck {

// PNG, 8 bits of grey: 255 is open sky, 0 canopy and what lies outside the circle, between them the pixel's
// share of sky (linear: a threshold of 128 is one half). Polar projection as in the photograph: equidistant,
// north at the top, east on the left. Written beside and renamed. Throws Error(kInputOutput).
void save_png(const HemisphericalPhotograph& photograph, const std::filesystem::path& path);

}  // namespace sunfleck
