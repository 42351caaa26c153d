// One line of the stability report: one closed form in one precision over a sweep of points.
#pragma once

#include <cstddef>
#include <string>

namespace sunfleck {

struct StabilityRow {
  std::string form, precision;  // "phi, printed form", "double"
  std::size_t points = 0;       // evaluated
  std::size_t not_finite = 0;   // NaN or infinite where the true value is a number that fits the precision
  double worst_relative_error = 0;  // over the finite points, against a value of higher precision
  std::string worst_at;             // the arguments of that point
};

}  // namespace sunfleck
