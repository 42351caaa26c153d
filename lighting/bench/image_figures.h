// How far pictures are from the truth, with the noise of both known apart. The truth is a path-traced picture
// in two halves of independent samples: their difference tells its noise, which is taken out of the squares
// (a truth that is not noise-free makes every picture look worse by its own variance).
#pragma once

#include <span>
#include <vector>

#include "lighting/render/render.h"

namespace sunfleck {

struct ImageTruth {
  Image mean;                   // of the halves: colours alone
  std::vector<Vec3> half_step;  // per pixel (first - second) / 2: its square is the variance of `mean`
  std::vector<char> counts;     // per pixel: 0 for the sun's disc and what it burns out
  double brightness = 0;        // mean of the channels over the pixels that count
  double noise = 0;             // RMS standard error of `mean` per pixel and channel, relative to brightness
};
// Pixels more than 20 times as bright as the mean of all but the brightest hundredth do not count: they would
// be all of the error and are white in any picture. Sizes must match and a side have 1 pixel at least.
ImageTruth image_truth(const Image& first_half, const Image& second_half);

// All but SSIM and FLIP relative to the truth's brightness, over pixels that count and the three channels.
struct ImageFigures {
  double bias = 0;                 // mean difference
  double bias_standard_error = 0;  // of it, by the noise of picture and truth
  double rmse = 0;                 // of one picture, without the truth's noise
  double noise = 0;                // part of rmse that differs between the repeats
  double floor = 0;                // the rest: what no number of samples takes away
  // image_difference.h; means of the repeats; the truth's noise is in them.
  double ssim = 1, flip = 0;
};
// `repeats`: two or more pictures of one way, equal but for their seeds, all of another seed than the truth.
ImageFigures compare(const ImageTruth& truth, std::span<const Image> repeats);

}  // namespace sunfleck
