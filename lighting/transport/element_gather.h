// Irradiance of the two faces of every element by the radiance in the grid: trilinear between cell centres,
//   E = pi sum Om_j |n.w_j| I_j / sum Om_j |n.w_j|   over the directions of the face's side,
// which gives even light exactly pi I; plain sums are off by up to 18 % with eight directions. Elements
// larger than a cell: the mean over their parts, each with the radiance of its cell. Shoots: light from
// outside only; see shoot_gain().
//
// The radiance of a cell knows the shade and the light of the leaf itself, which no leaf casts on itself; it
// is taken out by own_part(), by the weight that the leaf's own cell has between the eight centres.
#pragma once

#include "lighting/base/light_map.h"
#include "lighting/transport/leaf_scattering.h"
#include "lighting/transport/transport_scene.h"

namespace sunfleck::transport {

// Per element; 0 below the ground. `given`: radiosity of every part that is in `radiance`; empty: none.
std::vector<FacePair> gather(const TransportScene& scene, std::span<const float> radiance,
                             std::span<const FacePair> given, const RunControl& control);

// The same for two kinds of light in one pass.
struct GatheredPair {
  std::vector<FacePair> first, second;
};
GatheredPair gather_two(const TransportScene& scene, std::span<const float> first,
                        std::span<const float> second, std::span<const FacePair> given_second,
                        const RunControl& control);

// Needles of a shoot light each other: adds to light from outside. `leaf` by optics class.
void add_light_inside_shoot(const CellContents& contents, std::size_t element,
                            const std::vector<LeafBand>& leaf, ElementLight& light);

}  // namespace sunfleck::transport
