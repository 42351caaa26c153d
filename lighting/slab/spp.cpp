// Stable closed form of the simplified plane-parallel model; see spp.h for the assumptions.
#include "lighting/slab/spp.h"

#include <algorithm>
#include <cmath>

#include "lighting/slab/phi1.h"
#include "sim/base/contract.h"

namespace sunfleck {
namespace {

// What does not depend on the depth.
template <class Real>
struct Coefficients {
  Real extinction;   // a = 1 - omega T
  Real backward;     // b = omega R
  Real decay;        // lambda of [SPP] Eq. 17, per unit of depth
  Real deep_albedo;  // r: up over down in an infinitely deep slab
  Real sink;         // A: what a layer loses to absorption and to a dark ground
};

template <class Real>
Coefficients<Real> coefficients(const SlabMedium<Real>& medium) {
  const Real alpha = medium.absorption;
  const Real b = (Real(1) - alpha) * medium.backscatter;
  const Real a = alpha + b;
  const Real decay = std::sqrt(alpha * (alpha + Real(2) * b));  // [SPP] Eq. 17
  return {a, b, decay, a + decay > Real(0) ? b / (a + decay) : Real(0),
          alpha + b * (Real(1) - medium.ground_albedo)};
}

// sinh(lambda y) / lambda without its growth e^(lambda y).
template <class Real>
Real damped_sine(Real decay, Real y) {
  return y * phi1(Real(2) * decay * y);
}

// No absorption and nothing turns back: the scattered light goes on with the beam, the ground returns its
// part.
template <class Real>
SlabLight<Real> forward_only(Real before, Real ground_albedo) {
  return {std::exp(-before), -std::expm1(-before), ground_albedo};
}

// cosh(lambda y) without its growth.
template <class Real>
Real damped_cosine(Real decay, Real y) {
  return (Real(1) + std::exp(Real(-2) * decay * y)) / Real(2);
}

}  // namespace

template <class Real>
SlabLight<Real> spp(Real before, Real behind, const SlabMedium<Real>& medium) {
  SUNFLECK_EXPECTS(before >= Real(0) && behind >= Real(0));
  SUNFLECK_EXPECTS(medium.absorption >= Real(0) && medium.absorption <= Real(1));
  const Real tau = std::min(before, Real(kInfiniteOpticalDepth));
  const Real x = std::min(behind, Real(kInfiniteOpticalDepth));
  const Real rho = medium.ground_albedo;
  const auto [a, b, decay, r, sink] = coefficients(medium);
  if (a + decay == Real(0)) return forward_only(tau, rho);

  const Real thickness = tau + x;
  const Real sine_x = damped_sine(decay, x);
  const Real denominator = damped_cosine(decay, thickness) + sink * damped_sine(decay, thickness);
  const Real to_point = std::exp(-decay * tau);
  const Real there_and_back = std::exp(Real(-2) * decay * x);

  // Light against the beam: what the ground and the layer behind the point return.
  const Real one_minus_r = (medium.absorption + decay) / (a + decay);
  const Real rho_minus_r = r > Real(0.5) ? one_minus_r - (Real(1) - rho) : rho - r;
  const Real layer = b * ((Real(1) - rho) + rho * one_minus_r) * sine_x;
  const Real up = to_point * (rho * there_and_back + layer) / denominator;

  // Diffuse light with the beam: scattered forward only, then all that has turned back at least once; deeper
  // in, where the beam is the smaller part, all light that travels forward less the beam.
  const Real direct = std::exp(-tau);
  const Real all_down = to_point * (damped_cosine(decay, x) + sink * sine_x) / denominator;
  if (direct < all_down / Real(2)) return {direct, all_down - direct, up};
  const Real omega_forward = (Real(1) - medium.absorption) * (Real(1) - medium.backscatter);
  const Real forward = std::exp(-a * tau) * -std::expm1(-omega_forward * tau);
  const Real turned =
      b * to_point *
      (r * tau * phi1(b * r * tau) + rho_minus_r * there_and_back * damped_sine(decay, tau) / denominator);
  return {direct, std::max(forward + turned, Real(0)), up};
}

template SlabLight<float> spp(float, float, const SlabMedium<float>&);
template SlabLight<double> spp(double, double, const SlabMedium<double>&);
template SlabLight<long double> spp(long double, long double, const SlabMedium<long double>&);

}  // namespace sunfleck
