// Private to lighting/sky: what sky_weights is made of besides the sums, the bins of the sun's path and the
// intervals of a period.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "lighting/sky/sky_weights.h"

namespace sunfleck {

inline constexpr std::uint32_t kNoBin = std::numeric_limits<std::uint32_t>::max();

// Which bin each step of the series belongs to (kNoBin where there is no beam); only bins with energy are
// kept.
struct SunBins {
  std::vector<Vec3> to_sun;            // energy-weighted mean direction
  std::vector<double> half_angle_rad;  // of an even cone as wide as the sun's places in the bin
  std::vector<std::uint32_t> bin_of_step;
  double spread_deg = 0;  // energy-weighted RMS angle between the sun and its bin
};
SunBins sun_bins(const RadiationSeries& series, double bin_deg);

// The intervals of one kind that cover a period, in the order of time; the first and last may be cut.
std::vector<WeightInterval> intervals_of(IntervalKind kind, const TimeSpan& period);

}  // namespace sunfleck
