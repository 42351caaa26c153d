// Sunlit fraction of an element from its counts in one picture, and the variance of that.
#pragma once

#include "lighting/trace/raster_tile.h"

namespace sunfleck::trace {

struct SunlitEstimate {
  double fraction = 0, variance = 0;
};

// `looked_up`: at the element's random point, for an element that covers no pixel; negative: unknown, which
// counts as half.
SunlitEstimate sunlit_leaf(const SunTally& tally, double looked_up);
SunlitEstimate sunlit_shoot(const SunTally& tally, double looked_up);

// Mean over pictures of an element, each from its own point of the sun's disc.
class SunlitMean {
 public:
  void add(const SunlitEstimate& e) {
    sum_ += e.fraction;
    squares_ += e.fraction * e.fraction;
    variances_ += e.variance;
  }
  // The pictures' scatter beyond their own errors is the penumbra's; taken as of random points of the disc,
  // which is more than lattice points have.
  SunlitEstimate mean(int pictures) const;

 private:
  double sum_ = 0, squares_ = 0, variances_ = 0;
};

}  // namespace sunfleck::trace
