#include "lighting/study/light_emulator.h"

#include <algorithm>

#include "sim/base/contract.h"

namespace sunfleck {
namespace {

// Slope at node i: the harmonic mean of its neighbours' secants where they agree in sign, else level; ends:
// the secant beside them.
double slope(const std::vector<double>& x, const double* y, std::size_t i) {
  const auto secant = [&](std::size_t k) { return (y[k + 1] - y[k]) / (x[k + 1] - x[k]); };
  if (i == 0) return secant(0);
  if (i + 1 == x.size()) return secant(i - 1);
  const double before = secant(i - 1), after = secant(i);
  return before * after > 0 ? 2 * before * after / (before + after) : 0;
}

}  // namespace

double monotone_cubic(const std::vector<double>& nodes, const double* values, double x) {
  SUNFLECK_EXPECTS(nodes.size() >= 2);
  x = std::clamp(x, nodes.front(), nodes.back());
  const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, x);
  const auto i = static_cast<std::size_t>(above - nodes.begin()) - 1;
  const double h = nodes[i + 1] - nodes[i], t = (x - nodes[i]) / h, t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * values[i] + (t3 - 2 * t2 + t) * h * slope(nodes, values, i) +
         (3 * t2 - 2 * t3) * values[i + 1] + (t3 - t2) * h * slope(nodes, values, i + 1);
}

std::vector<double> LightEmulator::at(const std::vector<double>& place) const {
  SUNFLECK_EXPECTS(place.size() == axes.size() && (axes.size() == 1 || axes.size() == 2));
  const std::vector<double>& first = axes.front().nodes;
  const std::size_t inner = axes.size() == 2 ? axes[1].nodes.size() : 1;
  std::vector<double> light(sensors()), row(inner), column(first.size());
  for (std::size_t s = 0; s < light.size(); ++s) {
    for (std::size_t i = 0; i < first.size(); ++i) {
      for (std::size_t k = 0; k < inner; ++k) row[k] = values[i * inner + k][s];
      column[i] = inner == 1 ? row[0] : monotone_cubic(axes[1].nodes, row.data(), place[1]);
    }
    light[s] = monotone_cubic(first, column.data(), place[0]);
  }
  return light;
}

}  // namespace sunfleck
