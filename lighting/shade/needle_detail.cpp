#include "lighting/shade/needle_detail.h"

#include <algorithm>
#include <cmath>

#include "sim/base/contract.h"

namespace sunfleck {

double bough_pixels_within(double rms_error) {
  if (rms_error <= 0.02) return std::max(0.0, rms_error / 0.02);
  if (rms_error <= 0.03) return 1 + (rms_error - 0.02) / 0.01;
  return std::min(4.0, 2 + 2 * (rms_error - 0.03) / 0.012);
}

double bough_share(const Bough& bough, double footprint, double rms_error) {
  SUNFLECK_EXPECTS(footprint > 0);
  const NeedleCone& cone = bough.cone;
  if (2 * cone.radius / footprint >= 0.5) return 0;
  const double pixels = 2 * (cone.length * std::sin(cone.aperture_rad) + cone.radius) / footprint;
  const double threshold = bough_pixels_within(rms_error);
  return threshold > 0 ? std::clamp((1.2 - pixels / threshold) / 0.4, 0.0, 1.0) : 0;
}

NeedleDetail choose_needle_detail(const Bough& bough, double footprint, double rms_error, double uniform) {
  return uniform < bough_share(bough, footprint, rms_error) ? NeedleDetail::kBough : NeedleDetail::kNeedles;
}

}  // namespace sunfleck
