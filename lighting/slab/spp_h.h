// SPP-H: the two-hemisphere slab of spp.h with the right mean cosine of diffuse light, which makes it the
// two-stream solution of Dickinson and Sellers in slant optical depths. 4 to 9 % in slabs where [SPP] has 30
// to 50 %; for closed canopies only (an isolated crown comes out about 80 % too bright).
#pragma once

#include "lighting/slab/spp.h"

namespace sunfleck {

struct HemisphereMedium {
  double absorption = 1;             // 1 - leaf albedo, [0, 1]; taken as at least 1e-10
  double beam_backscatter = 0.5;     // R0: of light scattered out of the beam
  double diffuse_backscatter = 0.5;  // Rd: of diffuse light scattered again
  double ground_albedo = 0;
  double diffuse_cosine = 0.5;  // m: mean cosine of diffuse light over the beam's (leaf projections included)
};

// What does not depend on the depth: waves p (decays with depth) and q (against it), D = p + r q, U = r p +
// q.
template <class Real>
struct SppHWaves {
  Real decay = 0;               // lambda / m, per slant optical depth
  Real deep_albedo = 0;         // r
  Real one_minus_r = 1;         // without its cancellation
  Real feed_p = 0, feed_q = 0;  // of the beam into each wave, per depth
};
SppHWaves<double> spp_h_waves(const HemisphereMedium& medium);

// Fluence as in spp(); depths taken as at most 1e6. Double only: float loses three digits near resonance.
// Relative error of down + up below 1e-11 up to a thickness of 1e3 while absorption is above 1e-4, else below
// 1e-6.
SlabLight<double> spp_h(double before, double behind, const HemisphereMedium& medium);

// The same in the processor's longest type: what spp_h() is measured against.
SlabLight<long double> spp_h_extended(double before, double behind, const HemisphereMedium& medium);

}  // namespace sunfleck
