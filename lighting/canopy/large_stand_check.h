// How far the boxes of a large stand are off: rays through the real leaves and wood at some ground cells and
// trees drawn by lot, against what the sweeps say there, in the same run.
//
// Each sampled cell is met by `rays` rays from every direction of the sky and of the sun's bins, each tree by
// four times as many;
// their own noise, known from the counts, is taken out of the mean squares. The figures are of light over all
// intervals together; single intervals have fewer directions and larger errors. With n samples a root mean
// square is known to about 1 / sqrt(2 n): 9 % for 64.
#pragma once

#include "lighting/canopy/large_stand.h"

namespace sunfleck {

struct LargeStandCheckOptions {
  int cells = 64, trees = 64;  // 0 .. 10,000; as many as there are where there are fewer
  int rays = 8;                // per direction, 1 .. 1000
};

struct LargeStandCheck {
  std::size_t cells = 0, trees = 0;
  // Boxes less rays: of the light on ground cells as a share of open light, and of what trees intercept
  // relative to the sampled trees' light (so that bright trees count most). Errors: root mean squares without
  // the rays' noise, or the least that these rays can tell, where that is more.
  double ground_bias = 0, ground_error = 0, tree_bias = 0, tree_error = 0;
};

LargeStandCheck check_large_stand(const Forest& forest, const LargeStandPrepared& prepared,
                                  const StandSky& sky, const LargeStandLight& light,
                                  const LargeStandCheckOptions& options, const RunControl& control);

// Puts the errors into the tables' standard errors: of ground_total (share times open light) and
// tree_intercepted (relative).
void set_errors(const LargeStandCheck& check, const StandSky& sky, LargeStandLight& light);

}  // namespace sunfleck
