// From radiance to the bytes of a PNG.
#pragma once

#include <cstdint>
#include <vector>

#include "lighting/render/render.h"

namespace sunfleck {

// 3 bytes per pixel, sRGB (IEC 61966-2-1).
//   linear  the 99th percentile of the pixels' brightest channel is white (one per cent may burn out)
//   filmic  the geometric mean of the pixels' luminance becomes .16, then a curve with toe and shoulder
std::vector<std::uint8_t> tone_mapped(const Image& image, const ToneMap& tone);

}  // namespace sunfleck
