// See light_weights.h.
#include "lighting/canopy/light_weights.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/base/contract.h"
#include "sim/base/error.h"

namespace sunfleck {

namespace {

std::string entry(const char* list, std::size_t i) {
  return std::string(list) + "[" + std::to_string(i) + "]";
}

void check_directions(LightSource& source, const std::string& where) {
  for (std::size_t d = 0; d < source.size(); ++d) {
    const double length = glm::length(source.to_source[d]);
    if (!std::isfinite(length) || !(length > 0.0))
      throw_invalid(where + entry(".to_source", d), "is no direction", "a finite vector of length above 0");
    source.to_source[d] /= length;
  }
  if (!source.half_angle_rad.empty() && source.half_angle_rad.size() != source.size())
    throw_invalid(where + ".half_angle_rad",
                  "has " + std::to_string(source.half_angle_rad.size()) + " entries for " +
                      std::to_string(source.size()) + " directions",
                  "one per direction, or none");
  for (std::size_t d = 0; d < source.half_angle_rad.size(); ++d)
    if (!(source.half_angle_rad[d] >= 0.0 && source.half_angle_rad[d] <= 0.5 * kPi))
      throw_invalid(where + entry(".half_angle_rad", d), "is out of range", "0 to pi/2");
}

void check_strengths(const LightSource& source, const std::string& where) {
  const WeightRows& w = source.strength;
  if (w.row_begin.empty() || w.row_begin.back() != w.column.size() || w.value.size() != w.column.size() ||
      !std::is_sorted(w.row_begin.begin(), w.row_begin.end()))
    throw_invalid(where + ".strength", "has rows that do not fit its entries", "build it with end_row()");
  for (std::size_t i = 0; i < w.column.size(); ++i) {
    if (w.column[i] >= source.size())
      throw_invalid(where + entry(".strength", i),
                    "names direction " + std::to_string(w.column[i]) + " of " + std::to_string(source.size()),
                    "a direction that is there");
    if (!(w.value[i] >= 0.0 && std::isfinite(w.value[i])))
      throw_invalid(where + entry(".strength", i), "is negative or no number", "energy of 0 or more");
  }
}

}  // namespace

void WeightRows::add(std::size_t direction, double strength) {
  if (strength == 0.0) return;
  column.push_back(static_cast<std::uint32_t>(direction));
  value.push_back(strength);
}

WeightRows weight_rows(std::span<const double> matrix, std::size_t intervals, std::size_t directions,
                       const std::string& where) {
  if (matrix.size() != intervals * directions)
    throw_invalid(where,
                  "has " + std::to_string(matrix.size()) + " weights for " + std::to_string(intervals) +
                      " intervals and " + std::to_string(directions) + " directions",
                  std::to_string(intervals * directions) + " weights, interval by interval");
  WeightRows rows;
  for (std::size_t i = 0; i < intervals; ++i) {
    for (std::size_t d = 0; d < directions; ++d) rows.add(d, matrix[i * directions + d]);
    rows.end_row();
  }
  return rows;
}

LightSource sun_bins(std::span<const Vec3> to_sun, std::span<const double> half_angle_rad,
                     WeightRows beam_normal) {
  return {
      {to_sun.begin(), to_sun.end()}, {half_angle_rad.begin(), half_angle_rad.end()}, std::move(beam_normal)};
}

LightSource sky_patches(std::span<const Vec3> to_source, std::span<const double> solid_angle_sr,
                        WeightRows radiance) {
  SUNFLECK_EXPECTS(to_source.size() == solid_angle_sr.size());
  LightSource source{{to_source.begin(), to_source.end()}, {}, std::move(radiance)};
  for (const double solid_angle : solid_angle_sr)
    source.half_angle_rad.push_back(cone_half_angle_rad(solid_angle));
  for (std::size_t i = 0; i < source.strength.column.size(); ++i)
    source.strength.value[i] *= solid_angle_sr[source.strength.column[i]];
  return source;
}

double cone_half_angle_rad(double solid_angle_sr) {
  return std::acos(std::clamp(1.0 - solid_angle_sr / (2.0 * kPi), -1.0, 1.0));
}

StandSky checked(StandSky sky) {
  if (sky.sun.size() + sky.sky.size() == 0)
    throw_invalid("sky", "has no directions", "at least one sun or sky direction");
  for (auto [source, where] : {std::pair{&sky.sun, "sky.sun"}, {&sky.sky, "sky.sky"}}) {
    check_directions(*source, where);
    check_strengths(*source, where);
    if (source->strength.rows() != sky.intervals.size())
      throw_invalid(std::string(where) + ".strength",
                    "has " + std::to_string(source->strength.rows()) + " rows for " +
                        std::to_string(sky.intervals.size()) + " intervals",
                    "one row per interval, empty at night");
  }
  return sky;
}

std::vector<double> open_energy(const LightSource& source, const Vec3& normal) {
  const WeightRows& w = source.strength;
  std::vector<double> energy(w.rows(), 0.0);
  for (std::size_t r = 0; r < w.rows(); ++r)
    for (std::size_t i = w.row_begin[r]; i < w.row_begin[r + 1]; ++i) {
      const Vec3& to = source.to_source[w.column[i]];
      if (to.z > 0.0) energy[r] += w.value[i] * std::max(0.0, glm::dot(normal, to));
    }
  return energy;
}

std::vector<double> total_strength(const LightSource& source) {
  std::vector<double> total(source.size(), 0.0);
  for (std::size_t i = 0; i < source.strength.column.size(); ++i)
    total[source.strength.column[i]] += source.strength.value[i];
  return total;
}

}  // namespace sunfleck
