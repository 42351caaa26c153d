// m D' = -a D + b U + omega T0 e^-tau,  -m U' = -a U + b D + omega R0 e^-tau, D(0) = 0, and at the ground
// m U = rho (m D + e^-W). Solved in the waves p, q with D = p + r q, U = r p + q: p decays with depth, q
// against it, and each is fed by the beam through an integral that is positive and never overflows.
#include "lighting/slab/spp_h.h"

#include <algorithm>
#include <cmath>

#include "lighting/slab/phi1.h"
#include "sim/base/contract.h"

namespace sunfleck {
namespace {

// Integral of e^(-decay (tau - t)) e^-t over t in [0, tau]; decay = 1 needs no case of its own.
template <class Real>
Real fed_with_beam(Real decay, Real tau) {
  return std::exp(-std::min(decay, Real(1)) * tau) * tau * phi1(std::abs(Real(1) - decay) * tau);
}

// Integral of e^(-decay t) e^-t over t in [0, x].
template <class Real>
Real fed_against_beam(Real decay, Real x) {
  return x * phi1((Real(1) + decay) * x);
}

template <class Real>
SppHWaves<Real> waves_of(const HemisphereMedium& medium) {
  const Real alpha = std::max(medium.absorption, 1e-10), omega = Real(1) - alpha;
  const Real b = omega * Real(medium.diffuse_backscatter), m = medium.diffuse_cosine;
  const Real a = alpha + b;
  const Real root = std::sqrt(alpha * (alpha + Real(2) * b));
  const Real r = b / (a + root), one_minus_r = (alpha + root) / (a + root);
  const Real scale = omega / (m * one_minus_r * (Real(1) + r));
  const Real backward = medium.beam_backscatter, forward = Real(1) - backward;
  return {root / m, r, one_minus_r, scale * (forward + r * backward), scale * (backward + r * forward)};
}

template <class Real>
SlabLight<Real> light_of(Real before, Real behind, const HemisphereMedium& medium) {
  SUNFLECK_EXPECTS(before >= Real(0) && behind >= Real(0) && medium.diffuse_cosine > 0.0);
  const Real tau = std::min(before, Real(1e6)), x = std::min(behind, Real(1e6)), thickness = tau + x;
  const SppHWaves<Real> w = waves_of<Real>(medium);
  const Real r = w.deep_albedo, rho = medium.ground_albedo;
  const Real across = std::exp(-w.decay * thickness);

  // Both boundary conditions give q at the ground, then p at the lit side.
  const Real fed_q = w.feed_q * fed_against_beam(w.decay, thickness);
  const Real fed_p = w.feed_p * fed_with_beam(w.decay, thickness);
  const Real beam_on_ground = std::exp(-thickness) / Real(medium.diffuse_cosine);
  const Real loss = -std::expm1(Real(-2) * w.decay * thickness);  // 1 - across^2
  const Real determinant = w.one_minus_r * (Real(1) + r) + r * (r - rho) * loss;
  const Real q_ground = ((rho - r) * (fed_p - r * across * fed_q) + rho * beam_on_ground) / determinant;
  const Real p_lit = -r * (across * q_ground + fed_q);

  const Real p = std::exp(-w.decay * tau) * p_lit + w.feed_p * fed_with_beam(w.decay, tau);
  const Real q = std::exp(-w.decay * x) * q_ground + w.feed_q * std::exp(-tau) * fed_against_beam(w.decay, x);
  return {std::exp(-tau), std::max(p + r * q, Real(0)), std::max(r * p + q, Real(0))};
}

}  // namespace

SppHWaves<double> spp_h_waves(const HemisphereMedium& medium) { return waves_of<double>(medium); }

SlabLight<double> spp_h(double before, double behind, const HemisphereMedium& medium) {
  return light_of<double>(before, behind, medium);
}

SlabLight<long double> spp_h_extended(double before, double behind, const HemisphereMedium& medium) {
  return light_of<long double>(before, behind, medium);
}

}  // namespace sunfleck
