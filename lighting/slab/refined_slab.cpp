// Integrals along a line through the slab; see refined_slab.h.
#include "lighting/slab/refined_slab.h"

#include <algorithm>
#include <cmath>

#include "lighting/slab/phi1.h"
#include "sim/base/contract.h"
#include "sim/base/vec.h"

namespace sunfleck {
namespace {

constexpr double kDeepest = 1e6;
constexpr double kLargestGrowth = 600.0;  // of an exponent that a smaller one of the slab takes back

// phi1'(y) = (e^-y (1 + y) - 1) / y^2, by its series near 0.
double phi1_slope(double y) {
  if (std::abs(y) > 0.2) return (std::exp(-y) * (1.0 + y) - 1.0) / (y * y);
  // sum over k of (-1)^(k+1) (k+1) y^k / (k+2)!
  double term = -0.5, sum = -0.5;
  for (int k = 1; k < 14; ++k) {
    term *= -y * (k + 1.0) / (k * (k + 2.0));
    sum += term;
  }
  return sum;
}

// (phi1(y1) - phi1(y2)) / (y2 - y1), y1 <= y2.
double phi1_difference(double y1, double y2) {
  if (y2 - y1 < 1e-4 * (1.0 + std::abs(y1))) return -phi1_slope(0.5 * (y1 + y2));
  return (phi1(y1) - phi1(y2)) / (y2 - y1);
}

}  // namespace

RefinedSlab::RefinedSlab(double before, double behind, const SlabMedium<double>& medium)
    : tau_(std::min(before, kDeepest)),
      x_(std::min(behind, kDeepest)),
      ground_(medium.ground_albedo),
      albedo_(1.0 - medium.absorption) {
  SUNFLECK_EXPECTS(before >= 0.0 && behind >= 0.0);
  const double alpha = medium.absorption;
  backward_ = albedo_ * medium.backscatter;
  decay_ = std::sqrt(alpha * (alpha + 2.0 * backward_));
  const double a = alpha + backward_;
  const double one_minus_r = a + decay_ > 0.0 ? (alpha + decay_) / (a + decay_) : 1.0;
  sink_ = alpha + backward_ * (1.0 - ground_);
  one_minus_ground_r_ = (1.0 - ground_) + ground_ * one_minus_r;
  to_point_ = std::exp(-decay_ * tau_);
  beam_ = std::exp(-tau_);
  there_and_back_ = std::exp(-2.0 * decay_ * x_);
  const auto sine = [&](double y) { return y * phi1(2.0 * decay_ * y); };
  sine_ = sine(x_);
  const double whole = tau_ + x_;
  per_denominator_ = 1.0 / (0.5 * (1.0 + std::exp(-2.0 * decay_ * whole)) + sink_ * sine(whole));
  ground_radiance_ = spp<double>(whole, 0.0, medium).up / (2.0 * kPi);
}

// Towards the light, over [0, length] of depth: the slab's cosh and sinh terms grow with e^(decay t) there.
RefinedSlab::Integrals RefinedSlab::with_beam(double length, double rate) const {
  const double y1 = (rate - decay_) * length, y2 = (rate + decay_) * length;
  const double f1 = length * phi1(y1), f2 = length * phi1(y2);
  return {0.5 * (f1 + there_and_back_ * f2),
          sine_ * f1 + there_and_back_ * length * length * phi1_difference(y1, y2), there_and_back_ * f2,
          beam_ * length * phi1((rate - 1.0) * length)};
}

RefinedSlab::Integrals RefinedSlab::against_beam(double length, double rate) const {
  const double y1 = (rate - decay_) * length, y2 = (rate + decay_) * length;
  const double f1 = length * phi1(y1), f2 = length * phi1(y2);
  return {0.5 * (f2 + there_and_back_ * f1), sine_ * f1 - length * length * phi1_difference(y1, y2),
          there_and_back_ * f1, beam_ * length * phi1((rate + 1.0) * length)};
}

double RefinedSlab::radiance(const SlabLine& line, const ScatterShares& shares) const {
  SUNFLECK_EXPECTS(line.rate > 0.0 && line.true_end >= 0.0);
  const bool towards_light = line.cosine > 0.0;
  // A line that stays inside for a depth of 1e-300 of the slab is as good as level.
  const double slab = towards_light ? tau_ : x_;
  double length = std::min(slab, line.true_end / line.rate);
  const double growth = std::max(decay_, 1.0) - line.rate;
  if (growth > 0.0) length = std::min(length, kLargestGrowth / growth);
  const Integrals i = towards_light ? with_beam(length, line.rate) : against_beam(length, line.rate);
  const double e = to_point_ * per_denominator_;
  const double down = e * (i.cosine + sink_ * i.sine) - i.beam;
  const double up = e * (ground_ * i.ground + backward_ * one_minus_ground_r_ * i.sine);
  const double scattered =
      shares.from_down * std::max(down, 0.0) + shares.from_up * std::max(up, 0.0) + shares.from_beam * i.beam;
  double ground = 0.0;
  if (!towards_light && line.meets_ground)
    ground = std::exp(-std::min(line.rate * slab, line.true_end)) * ground_radiance_;
  return albedo_ * line.rate * scattered + ground;
}

}  // namespace sunfleck
