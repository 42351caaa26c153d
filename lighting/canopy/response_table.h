// What light from each direction does to each target, and its sum over the directions of an interval.
//
// Errors: responses are counts of rays, each worth `quantum`. A count varies by no more than its own size
// (Poisson; a share by p (1 - p)), so the variance of a sum is at most sum of strength^2 quantum response;
// rays are spread evenly, which makes the true error smaller.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "lighting/canopy/light_weights.h"
#include "sim/base/run_control.h"

namespace sunfleck {

struct ResponseTable {
  enum class Kind {
    kShare,  // of the light of the direction that arrives, 0 .. 1
    kAmount  // e.g. m2: what is taken from light of strength 1 on a facing plane
  };
  Kind kind = Kind::kAmount;
  std::size_t directions = 0, targets = 0;
  std::vector<float> value;     // [direction][target]
  std::vector<double> quantum;  // per direction

  ResponseTable() = default;
  ResponseTable(Kind which, std::size_t direction_count, std::size_t target_count)
      : kind(which),
        directions(direction_count),
        targets(target_count),
        value(direction_count * target_count),
        quantum(direction_count) {}
  std::span<float> row(std::size_t direction) { return {value.data() + direction * targets, targets}; }
  std::span<const float> row(std::size_t direction) const {
    return {value.data() + direction * targets, targets};
  }
};

struct IntervalTable {
  std::size_t intervals = 0, targets = 0;
  std::vector<float> value, standard_error;  // [interval][target]

  IntervalTable() = default;
  IntervalTable(std::size_t interval_count, std::size_t target_count)
      : intervals(interval_count),
        targets(target_count),
        value(interval_count * target_count),
        standard_error(interval_count * target_count) {}
  float at(std::size_t interval, std::size_t target) const { return value[interval * targets + target]; }
  float error_at(std::size_t interval, std::size_t target) const {
    return standard_error[interval * targets + target];
  }
};

// sum over directions of strength * factor * response, with its standard error. `factor` per direction (for
// example the cosine to a plane); empty: 1. Throws Error(kLimitExceeded) for more than 2e9 values.
IntervalTable weighted_sum(const ResponseTable& table, const WeightRows& strength,
                           std::span<const double> factor, const RunControl& control);

// a + b, errors as of independent values.
IntervalTable sum_of(const IntervalTable& a, const IntervalTable& b);

}  // namespace sunfleck
