// One ray through a bough, seen across the axis: where its optical depth is measured from. Private to the
// folder; bough.h has the formulas.
#pragma once

#include <algorithm>
#include <cmath>

#include "lighting/shade/bough.h"

namespace sunfleck {

// A place on the ray: position across the axis from the point of closest approach, and what G needs there.
struct LinePlace {
  double rho = 0, one_minus_u = 0, one_plus_u = 0;
  double minus = 0, plus = 0;  // sqrt(1 - cos beta), sqrt(1 + cos beta), beta between needle and ray
  double sin_needle() const { return minus * plus; }
};

struct BoughLine {
  double offset = 0;  // |y|, distance of the ray from the axis; floored
  double start = 0;   // t of the ray's origin

  BoughLine(const BoughVolume& volume, const Vec3& origin, const BoughDirection& d)
      : offset(std::max(std::abs(origin.x * d.across.y - origin.y * d.across.x), 1e-6 * volume.outer_radius)),
        start(origin.x * d.across.x + origin.y * d.across.y) {}

  double t(double distance, const BoughDirection& d) const { return start + distance * d.sine; }

  LinePlace place(double t, const BoughDirection& d) const {
    LinePlace p;
    const double y2 = offset * offset;
    p.rho = std::sqrt(y2 + t * t);
    const double far = 1 + std::abs(t) / p.rho, near = y2 / (p.rho * p.rho * far);  // 1 +- |u|
    p.one_minus_u = t > 0 ? near : far;
    p.one_plus_u = t > 0 ? far : near;
    p.minus = std::sqrt(d.one_minus_near + d.slope * p.one_minus_u);
    p.plus = std::sqrt(d.one_plus_far + d.slope * p.one_plus_u);
    return p;
  }
};

// scale (G(b) - G(a)), >= 0 for b behind a.
inline double depth_between(const LinePlace& a, const LinePlace& b, const BoughDirection& d) {
  // sin((beta -+ a)/2) up to common factors; the ratios of sines become squares over (1 -+ u).
  const double near_a = a.minus * d.plus_near + d.minus_near * a.plus;
  const double near_b = b.minus * d.plus_near + d.minus_near * b.plus;
  const double far_a = d.minus_far * a.plus + a.minus * d.plus_far;
  const double far_b = d.minus_far * b.plus + b.minus * d.plus_far;
  const double near = (near_a * near_a * b.one_minus_u) / (near_b * near_b * a.one_minus_u);
  const double far = (far_a * far_a * b.one_plus_u) / (far_b * far_b * a.one_plus_u);
  const double half_turn =
      std::atan2(b.minus * a.plus - a.minus * b.plus, b.plus * a.plus + b.minus * a.minus);
  const double depth =
      -2 * d.slope * half_turn + 0.5 * (d.sin_far * std::log(far) - d.sin_near * std::log(near));
  return std::max(0.0, d.scale * depth);
}

}  // namespace sunfleck
