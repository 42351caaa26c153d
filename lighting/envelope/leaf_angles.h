// How leaves stand, from the leaves themselves: their mean projection towards each sector and towards the
// sun, and how strongly they turn light from one direction into another.
//
// Uniformly turned leaves (what [Boulanger08] takes for granted) give G = 1/2 and the means Avt and Avr of
// Eq. 31 and 32; leaves that lie flat or stand upright are wrong by some 20 % that way. Measured over at most
// some thousand elements of every prototype, as they stand in the forest. Everything here is built from
//   m(v, w) = <M(N.v) M(N.w)>, area-weighted over leaf normals N, M(x) = max(x, 0):
// light from v that meets a leaf and leaves it towards -w is m(v, -w) or m(-v, w) where thrown back and m(v,
// w) or m(-v, -w) where let through.
#pragma once

#include <cstdint>
#include <vector>

#include "lighting/depth/blocker_field.h"
#include "lighting/envelope/envelope_options.h"
#include "lighting/envelope/sector_set.h"
#include "sim/base/run_control.h"

namespace sunfleck::envelope {

// A flat element of the sample.
struct SampledLeaf {
  Vec3f normal{0, 0, 1};  // unit, world
  float area_m2 = 0;
};

// Elements of one prototype with the same material.
struct AngleSample {
  std::uint16_t material = 0;
  double area_m2 = 0;
  std::vector<SampledLeaf> leaves;
  double even_share = 0;  // of the area: elements that count as turned evenly, as needles of shoots are
  double escape = 1;      // mean share of scattered light that leaves its own element
};

struct PrototypeAngles {
  std::vector<AngleSample> samples;  // by material; none without leaf area
  double wood_share = 0;  // wood's part of the projected area of leaves and wood, mean over directions
};

// One entry per prototype.
std::vector<PrototypeAngles> measure_leaf_angles(const Forest& forest, const ForestIndex& index,
                                                 const BlockerField& field, EnvelopeAngles angles,
                                                 const RunControl& control);

// Means of one sample; j, k are directions of the set.
struct AngleMoments {
  std::vector<double> facing;  // [j] <M(N.w_j)>; G_j is the sum of this and of the opposite's
  std::vector<double> pairs;   // [j * count + k] m(w_j, w_k)
};
AngleMoments angle_moments(const AngleSample& sample, const SectorSet& set);

// The same between the set and one more direction v.
struct LightMoments {
  double facing_towards = 0, facing_away = 0;  // <M(N.v)>, <M(-N.v)>
  std::vector<double> towards, away;           // [j] m(w_j, v), m(w_j, -v)
};
LightMoments light_moments(const AngleSample& sample, const SectorSet& set, const Vec3& direction);

}  // namespace sunfleck::envelope
