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
double fed_with_beam(double decay, double tau) {
  return std::exp(-std::min(decay, 1.0) * tau) * tau * phi1(std::abs(1.0 - decay) * tau);
}

// Integral of e^(-decay t) e^-t over t in [0, x].
double fed_against_beam(double decay, double x) { return x * phi1((1.0 + decay) * x); }

}  // namespace

SppHWaves spp_h_waves(const HemisphereMedium& medium) {
  const double alpha = std::max(medium.absorption, 1e-10), omega = 1.0 - alpha;
  const double b = omega * medium.diffuse_backscatter;
  const double a = alpha + b;
  const double root = std::sqrt(alpha * (alpha + 2.0 * b));
  const double r = b / (a + root), one_minus_r = (alpha + root) / (a + root);
  const double scale = omega / (medium.diffuse_cosine * one_minus_r * (1.0 + r));
  const double forward = 1.0 - medium.beam_backscatter;
  return {root / medium.diffuse_cosine, r, one_minus_r, scale * (forward + r * medium.beam_backscatter),
          scale * (medium.beam_backscatter + r * forward)};
}

SlabLight<double> spp_h(double before, double behind, const HemisphereMedium& medium) {
  SUNFLECK_EXPECTS(before >= 0.0 && behind >= 0.0 && medium.diffuse_cosine > 0.0);
  const double tau = std::min(before, 1e6), x = std::min(behind, 1e6), thickness = tau + x;
  const SppHWaves w = spp_h_waves(medium);
  const double r = w.deep_albedo, rho = medium.ground_albedo;
  const double across = std::exp(-w.decay * thickness);

  // Both boundary conditions give q at the ground, then p at the lit side.
  const double fed_q = w.feed_q * fed_against_beam(w.decay, thickness);
  const double fed_p = w.feed_p * fed_with_beam(w.decay, thickness);
  const double beam_on_ground = std::exp(-thickness) / medium.diffuse_cosine;
  const double loss = -std::expm1(-2.0 * w.decay * thickness);  // 1 - across^2
  const double determinant = w.one_minus_r * (1.0 + r) + r * (r - rho) * loss;
  const double q_ground = ((rho - r) * (fed_p - r * across * fed_q) + rho * beam_on_ground) / determinant;
  const double p_lit = -r * (across * q_ground + fed_q);

  const double p = std::exp(-w.decay * tau) * p_lit + w.feed_p * fed_with_beam(w.decay, tau);
  const double q =
      std::exp(-w.decay * x) * q_ground + w.feed_q * std::exp(-tau) * fed_against_beam(w.decay, x);
  return {std::exp(-tau), std::max(p + r * q, 0.0), std::max(r * p + q, 0.0)};
}

}  // namespace sunfleck
