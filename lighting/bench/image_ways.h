// The ways to a picture that are measured against each other: ONE table of names and settings. Whoever adds a
// way to render adds a line to image_ways().
#pragma once

#include <string>
#include <vector>

#include "lighting/render/render_config.h"

namespace sunfleck {

struct ImageWay {
  std::string name, what;
  RenderSettings settings;
};

// The first is the path-traced one that the others are compared with. `base` gives what all share: leaf
// outlines, gloss, textures. Noise targets are taken out: the samples are what is varied.
std::vector<ImageWay> image_ways(const RenderSettings& base);

// Names separated by commas, or "all"; path_traced comes first, asked for or not. Throws
// Error(kInvalidInput) listing the names.
std::vector<ImageWay> choose_image_ways(const std::vector<ImageWay>& ways, const std::string& names);

}  // namespace sunfleck
