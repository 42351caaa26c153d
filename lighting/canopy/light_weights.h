// Directions that light comes from, and how much of it each interval of a period sends from each.
//
// Strength of a direction: energy on a plane that faces it, in any unit the caller likes (W m-2, MJ m-2 per
// month, ...); all answers are in that unit, per m2 or times m2. A sky patch of solid angle Om and radiance L
// has strength L Om, and its to_source.z is best its mean cosine; a sun bin has the beam on a facing plane.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/base/vec.h"

namespace sunfleck {

// Rows of numbers of which most are 0: entries [row_begin[r], row_begin[r + 1]) belong to row r.
struct WeightRows {
  std::vector<std::size_t> row_begin{0};
  std::vector<std::uint32_t> column;  // direction
  std::vector<double> value;          // strength, >= 0

  std::size_t rows() const { return row_begin.size() - 1; }
  void add(std::size_t direction, double strength);  // to the row being built; 0 is left out
  void end_row() { row_begin.push_back(column.size()); }
};
// From a full matrix [interval][direction]; throws Error(kInvalidInput) at `where` if its size is not
// intervals * directions.
WeightRows weight_rows(std::span<const double> matrix, std::size_t intervals, std::size_t directions,
                       const std::string& where);

// Light of one kind: from the sun itself (direct) or from the sky (diffuse).
struct LightSource {
  std::vector<Vec3> to_source;  // unit after checked(); at or below the horizon: brings nothing
  // Light arrives evenly from a cone this wide round the direction (radians, 0 .. pi/2); empty: 0, parallel.
  std::vector<double> half_angle_rad;
  WeightRows strength;  // one row per interval

  std::size_t size() const { return to_source.size(); }
  double half_angle(std::size_t d) const { return half_angle_rad.empty() ? 0.0 : half_angle_rad[d]; }
};

struct StandSky {
  LightSource sun, sky;
  std::vector<std::string> intervals;  // labels, one per row of both
};

// Sources from what a sky model gives: rows as in WeightRows, values beam energy on a facing plane (sun) or
// radiance (sky patches, times solid angle here). Spans of one length per table; half angles may be empty.
LightSource sun_bins(std::span<const Vec3> to_sun, std::span<const double> half_angle_rad,
                     WeightRows beam_normal);
LightSource sky_patches(std::span<const Vec3> to_source, std::span<const double> solid_angle_sr,
                        WeightRows radiance);

// Half angle of the cone of that solid angle.
double cone_half_angle_rad(double solid_angle_sr);

// Throws Error(kInvalidInput) naming "sky.<field>": no direction at all, a direction not finite or of length
// 0 (else it comes back normalised), a negative or not finite strength, a column that is no direction,
// numbers of rows that differ, half angles out of range.
StandSky checked(StandSky sky);

// Energy on one m2 of a plane with this unit normal under open sky, per interval.
std::vector<double> open_energy(const LightSource& source, const Vec3& normal);

// Sum of strengths of each direction over all intervals.
std::vector<double> total_strength(const LightSource& source);

}  // namespace sunfleck
