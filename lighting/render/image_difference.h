// How far two pictures of one size are from each other.
#pragma once

#include <span>

#include "lighting/render/render.h"

namespace sunfleck {

struct ImageDifference {
  double bias = 0;           // mean of a over mean of b, less 1
  double mean_absolute = 0;  // mean over pixels and channels of |a - b|, relative to the mean of b
  double ssim = 1;           // of the luminances as a PNG shows them (sRGB, white at b's 99th percentile)
  double flip = 0;           // mean of flip.h over the same picture, at its usual distance
};
// Without the brightest hundredth of b's pixels (as image_noise). Sizes must match.
ImageDifference image_difference(const Image& a, const Image& b);

// Structural similarity of two grey pictures with values 0 to 1 (Wang, Bovik, Sheikh and Simoncelli 2004):
// Gaussian window of 11 x 11 pixels and standard deviation 1.5, K1 = .01, K2 = .03; mean over all windows
// that lie inside. At least 11 pixels on each side.
double structural_similarity(std::span<const double> a, std::span<const double> b, int width_px,
                             int height_px);

}  // namespace sunfleck
