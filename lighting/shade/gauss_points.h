// Gauss-Legendre points on [0, 1].
#pragma once

#include <array>
#include <cstddef>

namespace sunfleck {

template <std::size_t count>
struct GaussPoints {
  std::array<double, count> at, weight;
};

inline constexpr GaussPoints<8> kGauss8{
    {0.019855071751231884, 0.101666761293186630, 0.237233795041835507, 0.408282678752175098,
     0.591717321247824902, 0.762766204958164493, 0.898333238706813370, 0.980144928248768116},
    {0.050614268145188130, 0.111190517226687235, 0.156853322938943643, 0.181341891689180991,
     0.181341891689180991, 0.156853322938943643, 0.111190517226687235, 0.050614268145188130}};

// Weight of the value at point j in the integral from 0 to point i of what is known at the points: exact for
// polynomials up to degree count - 1 (integral of the Lagrange polynomial).
template <std::size_t count>
double running_weight(const GaussPoints<count>& points, std::size_t i, std::size_t j) {
  double weight = 0;
  for (std::size_t k = 0; k < count; ++k) {
    double lagrange = 1;
    for (std::size_t m = 0; m < count; ++m)
      if (m != j) lagrange *= (points.at[k] * points.at[i] - points.at[m]) / (points.at[j] - points.at[m]);
    weight += points.weight[k] * points.at[i] * lagrange;
  }
  return weight;
}

}  // namespace sunfleck
