// FLIP: how different two pictures look to someone who flips between them (Andersson, Nilsson,
// Akenine-Moeller, Oskarsson, Astrom and Fairchild 2020), the form for pictures of low dynamic range. Written
// from the paper's formulas.
//
// Two pipelines meet. Colour: both pictures in an opponent space (YCxCz), blurred as far as the eye does at
// this distance (contrast sensitivity), then the difference in CIELAB with chroma scaled by lightness (Hunt)
// by the HyAB distance, to the power .7, mapped to [0, 1]. Features: edges and points of the luminance by
// Gaussian derivatives; where they differ, the colour difference grows: FLIP = colour^(1 - feature).
// Black against white is .967, saturated green against blue 1.
#pragma once

#include <span>
#include <vector>

namespace sunfleck {

struct FlipOptions {
  // Of the viewer: a screen of 3840 pixels over .7 m seen from .7 m.
  double pixels_per_degree = 67.0206;  // [1, 1000]
};

struct FlipDifference {
  double mean = 0;             // over the pixels
  double weighted_median = 0;  // half of the summed difference lies in pixels above it
  double largest = 0;
  std::vector<float> map;  // per pixel, [0, 1]
};

// Colours: linear red, green and blue as the screen shows them (what sRGB encodes), 3 per pixel, row by row;
// limited to [0, 1]. Symmetric in a and b. Sizes must match and be at least 1 pixel.
FlipDifference flip_difference(std::span<const double> a, std::span<const double> b, int width_px,
                               int height_px, const FlipOptions& options = {});

}  // namespace sunfleck
