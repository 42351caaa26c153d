// The geometric compensation factor of [SPP] section 4.1 (there "G-factor"): how far a point's surroundings
// are from the infinite slab that the closed form assumes.
//
// For each sample direction the light scattered once into it is integrated along the line to the boundary of
// the slab and along the line to the true boundary; what is missing, relative to all of it, is the
// direction's shortfall ([SPP] Eq. 26, A.3; the printed form lacks the exponents' differences and is not
// used). Measured: it helps crowns of less than about two leaves' depth and takes too much light from dense
// ones.
#pragma once

#include <span>

namespace sunfleck {

// G_s of one direction, in [0, 1]: 0 where the medium reaches as far as the slab does, 1 where the boundary
// is at the point. `before` and `behind`: optical depths along the beam at the point; `boundary_depth`:
// optical depth from the point to the true boundary in the direction; `cosine`: between that direction and
// the one to the light. Absolute error below 1e-14 (double) or 5e-6 (float);
// also for long double.
template <class Real>
Real compensation_shortfall(Real before, Real behind, Real boundary_depth, Real cosine);

// [SPP] Eq. 27: G = 1 - mean of the shortfalls. `boundary_depths` and `cosines`: one per sample direction.
double compensation(double before, double behind, std::span<const float> boundary_depths,
                    std::span<const double> cosines);

}  // namespace sunfleck
