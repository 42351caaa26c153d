#include "lighting/bench/slab_phase.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/base/vec.h"

namespace sunfleck {

std::vector<double> legendre_row(std::size_t m, std::size_t last, double mu) {
  std::vector<double> p(last + 1, 0.0);
  double start = 1.0;
  for (std::size_t k = 1; k <= m; ++k) {
    const double n = static_cast<double>(k);
    start *= std::sqrt((2.0 * n - 1.0) / (2.0 * n) * std::max(0.0, 1.0 - mu * mu));
  }
  p[m] = start;
  const double order = static_cast<double>(m);
  for (std::size_t l = m + 1; l <= last; ++l) {
    const double n = static_cast<double>(l);
    const double before = l >= m + 2 ? p[l - 2] * std::sqrt((n - 1.0) * (n - 1.0) - order * order) : 0.0;
    p[l] = ((2.0 * n - 1.0) * mu * p[l - 1] - before) / std::sqrt(n * n - order * order);
  }
  return p;
}

GaussRule gauss_rule(int n) {
  GaussRule rule;
  for (int i = n; i >= 1; --i) {
    double x = std::cos(kPi * (i - 0.25) / (n + 0.5)), slope = 1.0;
    for (int step = 0; step < 20; ++step) {  // Newton's method on P_n
      double p = 1.0, last = 0.0;
      for (int l = 1; l <= n; ++l) last = std::exchange(p, ((2.0 * l - 1.0) * x * p - (l - 1.0) * last) / l);
      slope = n * (x * p - last) / (x * x - 1.0);
      x -= p / slope;
    }
    rule.points.push_back(0.5 * (1.0 + x));
    rule.weights.push_back(1.0 / ((1.0 - x * x) * slope * slope));
  }
  return rule;
}

double henyey_greenstein(double g, double cosine) {
  return (1.0 - g * g) / (4.0 * kPi * std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
}

// 1/2 sum over l of (2 l + 1) g^l P_l(cosine) int_0^1 P_l; the integral is 1 for l = 0, 0 for other even l.
double forward_share(double g, double cosine) {
  double sum = 0.5, integral = 0.5, power = g;
  const std::vector<double> p = legendre_row(0, 121, cosine);
  for (std::size_t l = 1; l <= 121; l += 2) {
    const double n = static_cast<double>(l);
    sum += 0.5 * (2.0 * n + 1.0) * power * p[l] * integral;
    integral *= -n / (n + 3.0);
    power *= g * g;
  }
  return sum;
}

}  // namespace sunfleck
