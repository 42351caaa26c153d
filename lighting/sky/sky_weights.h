// The light of any interval of a period as a weighted sum over fixed directions.
//
// A target (a sensor, a ground cell, a tree) responds to direction d with response[d]; a period gives every
// direction a weight per interval (the whole period, each month, day or hour). Then, for every interval i,
//   energy_j_m2[i] = days.beam_normal_j_m2.dot(i, sun_response) + days.sky_radiance_j_m2_sr.dot(i,
//   sky_response)
// where for a plane of normal n
//   sun_response[b] = share of the sun that reaches it from to_sun[b], times max(0, dot(n, to_sun[b]));
//   sky_response[p] = share of the patch it sees * max(0, dot(n, sky.to_source[p])) * solid_angle_sr[p].
// Responses are computed once; 8,784 hours then cost 8,784 short sums.
//
// Assumes the response is even across one sun bin (bin_deg, 2.5 degrees by default) and one patch. The sum
// over bins of weight * to_sun.z is each interval's direct horizontal energy and the same over patches its
// diffuse horizontal energy, both to rounding: binning moves light in direction, never in amount.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lighting/sky/radiation_series.h"
#include "lighting/sky/sky_patches.h"
#include "sim/base/run_control.h"
#include "sim/base/vec.h"

namespace sunfleck {

// Rows of numbers of which most are 0: entries [row_begin[r], row_begin[r + 1]) belong to row r, columns
// ascending.
struct SparseRows {
  std::vector<std::size_t> row_begin{0};
  std::vector<std::uint32_t> column;
  std::vector<double> value;

  std::size_t rows() const { return row_begin.size() - 1; }
  double dot(std::size_t row, std::span<const double> response) const;
};

enum class IntervalKind { kPeriod, kMonth, kDay, kHour };  // of the period's own clock

struct WeightInterval {
  double begin_s = 0, end_s = 0;  // seconds since 2000-01-01T00:00 UTC, cut to the period
  std::string label;              // "2024-05-01T00:00+01:00/2024-11-01T00:00+01:00", "2024-05", "2024-05-17",
                                  // "2024-05-17T13:00+01:00"
};

// One row per interval, in the order of time and without gaps. Nights have empty rows.
struct IntervalWeights {
  IntervalKind kind = IntervalKind::kPeriod;
  std::vector<WeightInterval> intervals;
  SparseRows beam_normal_j_m2;      // columns: SkyWeights::to_sun; energy on a plane that faces the bin
  SparseRows sky_radiance_j_m2_sr;  // columns: SkyWeights::sky; radiance summed over time
  std::vector<double> direct_horizontal_j_m2, diffuse_horizontal_j_m2;  // open sky, per interval

  double global_horizontal_j_m2(std::size_t i) const {
    return direct_horizontal_j_m2[i] + diffuse_horizontal_j_m2[i];
  }
};

struct SkyWeightOptions {
  SkyModel sky = SkyModel::kStandardOvercast;
  double patch_deg = 12;                     // sky patches, [1, 30]: 12 makes 163, 6 makes 573
  double bin_deg = 2.5;                      // sun bins, [1, 30]
  IntervalKind finest = IntervalKind::kDay;  // kHour: hours as well; kPeriod: nothing but the whole
};

// The directions of a period and their weights. Only bins that the sun visits with energy are there.
struct SkyWeights {
  SkyDirections sky;
  std::vector<Vec3> to_sun;  // energy-weighted mean direction of each bin, unit, z > 0
  // Per bin: half angle of an even cone as wide as the sun's own places in the bin. Response averaged over
  // the cone instead of asked at its middle: error of a season's direct light through gaps of 10 degrees, RMS
  // of 200 canopies, 0.8 -> 0.2 % at 2.5 degrees, 2.0 -> 0.5 % at 5, 4.7 -> 1.3 % at 10.
  std::vector<double> sun_half_angle_rad;
  double bin_spread_deg = 0;            // energy-weighted RMS angle between the sun and its bin's direction
  IntervalWeights period;               // one row
  IntervalWeights months, days, hours;  // empty where `finest` is coarser
};

// Each step's sun goes into the bin it stands in; its beam_normal_j_m2 is multiplied by the ratio of the
// sines of elevation, which keeps the horizontal energy. kPerez takes clearness and brightness of each step
// from its own radiation. Throws Error(kInvalidInput) naming "sky_weights.<option>" for options out of range;
// kCancelled.
SkyWeights sky_weights(const RadiationSeries& series, const SkyWeightOptions& options,
                       const RunControl& control = {});

}  // namespace sunfleck
