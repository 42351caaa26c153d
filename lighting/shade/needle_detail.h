// Which of the three levels of [Meyer00] a bough of needles is drawn at, from its size in pixels.
//
// With p the footprint, the pixel cone's diameter at the bough: needles while a needle is half a pixel wide
// or more; one bough while its diameter is at most T pixels, T from the error the picture may have. Measured
// on one fir (design sheet, RMS of radiance on a scale 0 to 1): T = 1 for .02, 2 for .03, 4 for .042. Between
// the two, needles. Cones are never chosen: on a CPU they cost as much as boughs and win nothing.
#pragma once

#include "lighting/shade/bough.h"

namespace sunfleck {

enum class NeedleDetail { kNeedles, kBough };

// Largest diameter in pixels at which a bough stays within this RMS error; linear between the measured
// points, proportional below them, at most 4. 0 for an error of 0.
double bough_pixels_within(double rms_error);

// Share of samples to draw as one bough: 1 below 80 % of the threshold, 0 above 120 %, linear between, so
// that nothing pops as a camera moves. Always 0 where needles are half a pixel wide. footprint > 0.
double bough_share(const Bough& bough, double footprint, double rms_error);

// One choice per sample or per bough: `uniform` in [0, 1), the same for all rays of that sample.
NeedleDetail choose_needle_detail(const Bough& bough, double footprint, double rms_error, double uniform);

}  // namespace sunfleck
