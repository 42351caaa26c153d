// What the foliage around a leaf does to light in one band: how much of the light from each sector, and from
// the sun, a path through it sends on towards the leaf.
//
// Along sector w_j, a piece of path of optical depth dx sends radiance
//   dx ( sum_k turn_jk L_k + sun_j E )
// for radiance L_k arriving from w_k and a beam E of the sun, both as they are there. For leaves alone
// turn_jk = Om_k Gam_jk / G_j with
//   Gam_jk = (r_f m(w_k, -w_j) + r_b m(-w_k, w_j) + t_f m(w_k, w_j) + t_b m(-w_k, -w_j)) / pi
// (leaf_angles.h); scaled so that what a beam from w_k loses and what it sends on balance exactly for r + t =
// 1 on this set of directions. Uniformly turned leaves recover B(alpha) / (3 pi^2) of the closed forms. Wood
// reflects like leaves of its bark turned evenly. Needles of a shoot catch part of each other's light: a
// shoot has the albedo a e / (1 - a (1 - e)), e the share of light from inside that gets out.
#pragma once

#include <vector>

#include "lighting/envelope/leaf_angles.h"
#include "lighting/optics/optics.h"

namespace sunfleck::envelope {

// What no band changes, of one prototype.
struct PrototypeMoments {
  std::vector<AngleMoments> set;  // by sample
  std::vector<LightMoments> sun;  // by sample; empty without sun
};
PrototypeMoments prototype_moments(const PrototypeAngles& angles, const SectorSet& set);

struct Scattering {
  std::size_t count = 0;           // of directions
  std::vector<double> turn;        // [j * count + k], sr
  std::vector<double> sun_turn;    // [j], 1/sr; empty without sun
  std::vector<double> projection;  // G_j of leaves and wood together, per leaf area
  double mean_projection = 0.5;
  double sun_projection = 0.5;
  double albedo = 0;  // share of the light met that is sent on, mean over directions, in [0, 1]
};

// `leaf` by sample. `to_sun` is used where moments.sun is filled.
Scattering scattering(const PrototypeAngles& angles, const PrototypeMoments& moments, const SectorSet& set,
                      const Vec3& to_sun, const std::vector<LeafOptics>& leaf, double bark_reflectance);

}  // namespace sunfleck::envelope
