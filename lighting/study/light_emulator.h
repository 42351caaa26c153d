// The light at sensors as a smooth function of one or two parameters of the stand, from a few runs.
//
// Runs on a grid of nodes; between them monotone cubic Hermite interpolation along each axis (Fritsch and
// Carlson 1980, SIAM J. Numer. Anal. 17; slopes by the harmonic mean of Fritsch and Butland 1984), so that
// light that falls with leaf area at the nodes falls everywhere.
#pragma once

#include <cstddef>
#include <vector>

namespace sunfleck {

// Rising nodes in whatever scale is smooth (say the logarithm of a factor); two or more.
struct EmulatorAxis {
  std::vector<double> nodes;
};

// y(x) through (nodes, values); x is held within the nodes.
double monotone_cubic(const std::vector<double>& nodes, const double* values, double x);

struct LightEmulator {
  std::vector<EmulatorAxis> axes;           // one or two
  std::vector<std::vector<double>> values;  // [node; the last axis fastest][sensor]

  std::size_t sensors() const { return values.front().size(); }
  // Light at every sensor.
  std::vector<double> at(const std::vector<double>& place) const;
};

}  // namespace sunfleck
