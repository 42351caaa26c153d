// The closed forms as [SPP] prints them, with the signs and factors that need it mended but the growing
// exponentials and differences left in: what the stable forms are compared with, for stability.h and tests
// only. They overflow, divide 0 by 0 and lose all digits well inside the range of a forest.
#pragma once

#include <cmath>

namespace sunfleck::printed {

template <class Real>
struct Light {
  Real down, up;
};

// Eq. 19: down = c1 alpha e^(-lambda t) + c2 e^-t + c3 e^(lambda t), up with alpha the other way round.
template <class Real>
struct Solution {
  Real decay, alpha, c1, c3;
};
template <class Real>
Solution<Real> solution(Real thickness, Real absorption, Real backscatter) {
  const Real omega = Real(1) - absorption, c2 = Real(-1);
  const Real decay = std::sqrt((Real(1) - omega * (Real(1) - Real(2) * backscatter)) * (Real(1) - omega));
  const Real alpha = omega * backscatter / (Real(1) - omega * (Real(1) - backscatter) - decay);
  const Real e1 = std::exp(-decay * thickness), e3 = std::exp(decay * thickness);
  const Real determinant = alpha * alpha * e3 - e1;
  return {decay, alpha, -alpha * e3 * c2 / determinant, e1 * c2 / determinant};
}

// Black ground.
template <class Real>
Light<Real> spp(Real tau, Real thickness, Real absorption, Real backscatter) {
  const auto [decay, alpha, c1, c3] = solution(thickness, absorption, backscatter);
  return {c1 * alpha * std::exp(-decay * tau) - std::exp(-tau) + c3 * std::exp(decay * tau),
          c1 * std::exp(-decay * tau) + c3 * alpha * std::exp(decay * tau)};
}

// SPP-H by the textbook: particular solution in e^-t, homogeneous ones in e^(+-lambda t).
template <class Real>
Light<Real> spp_h(Real tau, Real thickness, Real absorption, Real r0, Real rd, Real rho, Real m) {
  const Real omega = Real(1) - absorption, b = omega * rd, a = absorption + b;
  const Real root = std::sqrt(a * a - b * b), decay = root / m, r = b / (a + root);
  const Real determinant = a * a - m * m - b * b;
  const Real p = (omega * (Real(1) - r0) * (a + m) + b * omega * r0) / determinant;
  const Real q = ((a - m) * omega * r0 + b * omega * (Real(1) - r0)) / determinant;
  const Real falling = std::exp(-decay * thickness), rising = std::exp(decay * thickness);
  const Real beam = std::exp(-thickness);
  // c1 + r c2 = -p; (r - rho) falling c1 + (1 - rho r) rising c2 = beam (rho (p + 1/m) - q)
  const Real side = beam * (rho * (p + Real(1) / m) - q);
  const Real d = (Real(1) - rho * r) * rising - r * (r - rho) * falling;
  const Real c2 = (side + (r - rho) * falling * p) / d, c1 = -p - r * c2;
  const Real e1 = std::exp(-decay * tau), e2 = std::exp(decay * tau), e = std::exp(-tau);
  return {c1 * e1 + r * c2 * e2 + p * e, r * c1 * e1 + c2 * e2 + q * e};
}

// A.3 with the exponents' differences it lacks.
template <class Real>
Real shortfall(Real before, Real behind, Real boundary, Real cosine) {
  const Real c = std::abs(cosine), slab = cosine > Real(0) ? before : behind, reached = boundary * c;
  const Real k = Real(1) / c + (cosine > Real(0) ? Real(-1) : Real(1));
  if (reached >= slab) return Real(0);
  return (std::exp(-k * reached) - std::exp(-k * slab)) / (Real(1) - std::exp(-k * slab));
}

// A.1 and A.2 for isotropic scattering and a black ground; `cosine` > 0 looks to the lit side.
template <class Real>
Real refined(Real tau, Real thickness, Real absorption, Real backscatter, Real cosine) {
  const auto [decay, alpha, c1, c3] = solution(thickness, absorption, backscatter);
  const Real k = Real(1) / std::abs(cosine), omega = Real(1) - absorption;
  const auto integral = [&](Real growth) {  // of e^(growth t) over the line, weakened on its way
    if (cosine > Real(0)) return std::exp(-k * tau) * (std::exp((k + growth) * tau) - Real(1)) / (k + growth);
    return std::exp(k * tau) * (std::exp((growth - k) * thickness) - std::exp((growth - k) * tau)) /
           (growth - k);
  };
  const Real falling = integral(-decay), beam = integral(Real(-1)), rising = integral(decay);
  const Real down = c1 * alpha * falling - beam + c3 * rising, up = c1 * falling + c3 * alpha * rising;
  return omega * k * (down + up + beam) / Real(4 * 3.14159265358979323846);
}

}  // namespace sunfleck::printed
