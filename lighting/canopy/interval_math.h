// Small arithmetic on tables of intervals.
#pragma once

#include <vector>

#include "lighting/canopy/response_table.h"

namespace sunfleck {

// part / whole with both errors; 0 where there is nothing.
IntervalTable ratio_of(const IntervalTable& part, const IntervalTable& whole);

// Every row divided by its own number; 0 where that is 0.
IntervalTable divided(IntervalTable table, const std::vector<double>& by);

// One target over the intervals.
std::vector<double> column_of(const IntervalTable& table, std::size_t target);

// a / b, 0 where b is 0.
std::vector<double> quotient(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace sunfleck
