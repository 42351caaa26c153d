// See interval_math.h.
#include "lighting/canopy/interval_math.h"

#include <cmath>

namespace sunfleck {

IntervalTable ratio_of(const IntervalTable& part, const IntervalTable& whole) {
  IntervalTable out(part.intervals, part.targets);
  for (std::size_t i = 0; i < out.value.size(); ++i) {
    if (!(whole.value[i] > 0.0f)) continue;
    out.value[i] = part.value[i] / whole.value[i];
    out.standard_error[i] =
        std::hypot(part.standard_error[i], out.value[i] * whole.standard_error[i]) / whole.value[i];
  }
  return out;
}

IntervalTable divided(IntervalTable table, const std::vector<double>& by) {
  for (std::size_t i = 0; i < table.value.size(); ++i) {
    const double whole = by[i / table.targets];
    const float factor = whole > 0.0 ? static_cast<float>(1.0 / whole) : 0.0f;
    table.value[i] *= factor;
    table.standard_error[i] *= factor;
  }
  return table;
}

std::vector<double> column_of(const IntervalTable& table, std::size_t target) {
  std::vector<double> column(table.intervals);
  for (std::size_t i = 0; i < table.intervals; ++i) column[i] = table.at(i, target);
  return column;
}

std::vector<double> quotient(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> out(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) out[i] = b[i] > 0.0 ? a[i] / b[i] : 0.0;
  return out;
}

}  // namespace sunfleck
