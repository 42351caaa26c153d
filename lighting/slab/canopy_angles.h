// How the leaves of a whole forest are turned against its ground, measured from their normals: what SPP-H
// needs to know of a closed canopy. Means over all instances, weighted by leaf area; leaf angles are taken as
// even in azimuth, as the hemispheres of the model are. Needles of a shoot look everywhere alike.
#pragma once

#include <array>

#include "lighting/slab/spp_h.h"
#include "sim/forest/forest.h"

namespace sunfleck {

class CanopyAngles {
 public:
  // At most 4,096 leaves of a prototype are looked at, evenly picked.
  explicit CanopyAngles(const Forest& forest);

  // <(n.N)^2>, N the normal of the ground: 1/3 for randomly turned leaves, 1 for flat ones.
  double mean_square_cosine() const { return mean_square_cosine_; }
  // Ecology's G: <|n.s|> over leaves and azimuths for light at this cosine to N, in [0, 1].
  double leaf_projection(double cosine) const;
  // Integral of mu / G(mu) over mu in [0, 1]; 1 for randomly turned leaves (G = 1/2).
  double diffuse_cosine() const { return diffuse_cosine_; }

  // The medium for a beam at `cosine` to N (at least 1e-4 is used): m = diffuse_cosine() G / cosine, beam
  // backscatter 1/2 + (q/2) <(n.N)^2> cosine / G, diffuse backscatter 1/2 + (q/2) <(n.N)^2> for leaves with
  // q = (r - t) / (r + t).
  // Diffuse fluence is per fluence of a beam of which leaves see as much as of diffuse light, half; what they
  // see of the real beam is G: multiply both hemispheres by fluence_scale(), 1 for randomly turned leaves.
  // Without it the model balances fluxes but not what leaves absorb.
  HemisphereMedium medium(double cosine, double absorption, double turn, double ground_albedo) const;
  double fluence_scale(double cosine) const { return 2.0 * leaf_projection(cosine); }

 private:
  static constexpr std::size_t kSteps = 16;
  std::array<double, kSteps + 1> projection_{};  // at cosines k / kSteps
  double mean_square_cosine_ = 1.0 / 3.0, diffuse_cosine_ = 1.0;
};

}  // namespace sunfleck
