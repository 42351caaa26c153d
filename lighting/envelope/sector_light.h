// Light of the eight sectors on one leaf: sky (Eq. 6), sun (Eq. 8), one bounce of sun (Eq. 23 in optical
// depths, clamped) and light thrown back by the ground.
//
// Irradiance of a face with normal n from a sector of radiance L_j is L_j times
//   pi M(n.w_j) Om_j / sum_k M(n.w_k) Om_k,
// so that light that is the same from everywhere gives exactly pi L on any leaf; the plain sum of Eq. 6 gives
// 0.82 to 1.16 of that, depending on n. A sector's sky radiance is its mean over the octant. The ground is
// bright everywhere as if nothing stood on it. A shoot's needles face everywhere: M(n.w) becomes its mean
// 1/4, weakened by the other needles of the shoot.
#pragma once

#include <array>
#include <vector>

#include "lighting/base/light_map.h"
#include "lighting/depth/blocker_field.h"
#include "lighting/envelope/closed_forms.h"
#include "lighting/envelope/envelope_estimator.h"

namespace sunfleck::envelope {

inline constexpr double kSectorSolidAngle = 0.5 * kPi;

// Mean of a sky model's relative radiance over an octant above the horizon, 1/sr.
double octant_sky_radiance(const SkyRadiance& sky);

// What one band brings, no leaf in the way.
struct BandSectors {
  double beam_w_m2 = 0;                                     // on a plane facing the sun; 0 with the sun down
  std::array<double, 8> sky_radiance{}, ground_radiance{};  // W m-2 sr-1
  // Radiance of a sector by one bounce of sun is this times one_bounce_integral(); per prototype, as every
  // leaf's neighbours are taken to be like the mean leaf of its own prototype.
  std::vector<std::array<double, 8>> bounce_radiance;
};

struct SectorLight {
  bool sun = false;
  Vec3 to_sun{0, 0, 1};
  std::array<double, 8> approach{};  // c_j: by how much the depth to the sun shrinks per depth towards w_j
  std::vector<BandSectors> bands;
};

// Area-weighted mean leaf of a prototype in a band.
LeafSums<double> mean_leaf(const Forest& forest, const OpticsTable& optics, std::size_t band,
                           std::size_t prototype);

// `sun`: whether any direct light is to be computed. `light` must be checked().
SectorLight sector_light(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                         const BlockerField& field, EnvelopeSun method, bool sun);

// What a leaf stores.
struct LeafDepths {
  std::array<float, 8> sectors{};
  float sun = 0;
};

// Fractions of a leaf that no band changes.
struct LeafTransfer {
  std::array<double, 8> front{}, back{};  // irradiance per sector radiance, sr
  std::array<double, 8> transmittance{};  // T_j
  std::array<double, 8> bounce{};         // J_j
  double sun_front = 0, sun_back = 0;     // irradiance per beam irradiance
  double sunlit = 0;                      // share of the area the sun sees
};
LeafTransfer leaf_transfer(const FieldElement& element, const LeafDepths& depths, const SectorLight& light);

// Both faces in one band; absorbed_w is left 0.
ElementLight element_light(const LeafTransfer& leaf, const BandSectors& band, std::size_t prototype);

}  // namespace sunfleck::envelope
