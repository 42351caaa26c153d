// [SPP] Eq. 26 and 27 as ratios of expm1: no difference of two large exponents is ever formed.
#include "lighting/slab/compensation.h"

#include <algorithm>
#include <cmath>

#include "lighting/slab/spp.h"
#include "sim/base/contract.h"

namespace sunfleck {
namespace {

// Integral of e^(-k t) over [0, part] over that over [0, whole], 0 < part <= whole; k may be 0 or infinite.
template <class Real>
Real exponential_share(Real k, Real part, Real whole) {
  const Real denominator = -std::expm1(-k * whole);
  return denominator > Real(0) ? -std::expm1(-k * part) / denominator : part / whole;
}

}  // namespace

template <class Real>
Real compensation_shortfall(Real before, Real behind, Real boundary_depth, Real cosine) {
  SUNFLECK_EXPECTS(before >= Real(0) && behind >= Real(0) && boundary_depth >= Real(0));
  if (cosine == Real(0)) return std::exp(-boundary_depth);  // both limits agree
  constexpr Real kDeepest = static_cast<Real>(kInfiniteOpticalDepth);
  const Real slab = std::min(cosine > Real(0) ? before : behind, kDeepest);  // on this side of the point
  if (slab == Real(0)) return boundary_depth == Real(0) ? Real(1) : Real(0);
  const Real reached = boundary_depth * std::abs(cosine);  // depth at which the true boundary lies
  if (reached >= slab) return Real(0);
  // With the beam the light weakens away from the boundary, against it towards it: 1/c - 1 and 1/|c| + 1.
  const Real side = cosine > Real(0) ? Real(-1) : Real(1);
  const Real k = Real(1) / std::abs(cosine) + side;
  const Real to_boundary = std::exp(-boundary_depth * (Real(1) + side * std::abs(cosine)));
  return to_boundary * exponential_share(std::max(k, Real(0)), slab - reached, slab);
}

template float compensation_shortfall(float, float, float, float);
template double compensation_shortfall(double, double, double, double);
template long double compensation_shortfall(long double, long double, long double, long double);

double compensation(double before, double behind, std::span<const float> boundary_depths,
                    std::span<const double> cosines) {
  SUNFLECK_EXPECTS(!cosines.empty() && boundary_depths.size() == cosines.size());
  double sum = 0.0;
  for (std::size_t j = 0; j < cosines.size(); ++j)
    sum += compensation_shortfall(before, behind, static_cast<double>(boundary_depths[j]), cosines[j]);
  return std::clamp(1.0 - sum / static_cast<double>(cosines.size()), 0.0, 1.0);
}

}  // namespace sunfleck
