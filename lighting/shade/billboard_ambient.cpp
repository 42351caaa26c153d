#include "lighting/shade/billboard_cloud.h"
#include "sim/base/contract.h"

namespace sunfleck {

std::array<double, 4> fit_corner_ambient(std::span<const AmbientPoint> points) {
  SUNFLECK_EXPECTS(!points.empty());
  double mean = 0;
  for (const AmbientPoint& p : points) mean += p.value / static_cast<double>(points.size());
  // Normal equations for what each corner differs from the mean, with a slight pull to it.
  std::array<std::array<double, 5>, 4> m{};
  for (std::size_t k = 0; k < 4; ++k) m[k][k] = 1e-6;
  for (const AmbientPoint& p : points) {
    const std::array<double, 4> w{(1 - p.a) * (1 - p.b) / 4, (1 + p.a) * (1 - p.b) / 4,
                                  (1 - p.a) * (1 + p.b) / 4, (1 + p.a) * (1 + p.b) / 4};
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) m[i][j] += w[i] * w[j];
      m[i][4] += w[i] * (p.value - mean);
    }
  }
  for (std::size_t i = 0; i < 4; ++i)  // positive definite: no pivoting
    for (std::size_t row = i + 1; row < 4; ++row) {
      const double factor = m[row][i] / m[i][i];
      for (std::size_t column = i; column < 5; ++column) m[row][column] -= factor * m[i][column];
    }
  std::array<double, 4> corner{};
  for (std::size_t i = 4; i-- > 0;) {
    double rest = m[i][4];
    for (std::size_t j = i + 1; j < 4; ++j) rest -= m[i][j] * corner[j];
    corner[i] = rest / m[i][i];
  }
  for (double& value : corner) value += mean;
  return corner;
}

}  // namespace sunfleck
