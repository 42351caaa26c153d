// The light of any interval of a period as a weighted sum over fixed directions.
//
// A target (a sensor, a ground cell, a tree) responds to direction d with response[d]; a period gives every
// direction a weight per interval (the whole period, each month, day or hour). Then, for every interval i,
//   energy_j_m2[i] = sum over sun bins b    of beam.at(i, b) * sun_response[b]
//                  + sum over sky patches p of sky.at(i, p) * sky_response[p]
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

#include "lighting/sky/sky_patches.h"
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

enum class IntervalKind { kPeriod, kMonth, kDay, kHour };  // local civil time of the period's own offset

struct WeightInterval {
  double begin_s = 0, end_s = 0;  // seconds since 2000-01-01T00:00 UTC
  std::string label;  // "2024-05-01/2024-11-01", "2024-05", "2024-05-17", "2024-05-17T13:00+01:00"
};

// One row per interval, in time order and without gaps. Nights have empty rows.
struct IntervalWeights {
  std::vector<WeightInterval> intervals;
  SparseRows beam_normal_j_m2;      // columns: SkyBasis::to_sun; energy on a plane that faces the bin
  SparseRows sky_radiance_j_m2_sr;  // columns: SkyBasis::sky; radiance summed over time
  std::vector<double> direct_horizontal_j_m2, diffuse_horizontal_j_m2;  // open sky, per interval
};

// The directions of a period. Only bins the sun visits with energy are there.
struct SkyBasis {
  SkyDirections sky;
  std::vector<Vec3> to_sun;  // energy-weighted mean direction of each bin, unit, z > 0
};

}  // namespace sunfleck
