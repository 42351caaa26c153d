// How a prototype's real leaves scatter light from a direction and from two hemispheres around it into
// another: means over their normals instead of a phase function.
#pragma once

#include "lighting/slab/refined_slab.h"
#include "sim/base/vec.h"
#include "sim/plant/prototype.h"

namespace sunfleck {

// Area-weighted means over leaves, m their normal on the side that is seen when looking in a direction s:
struct LeafScatter {
  double projection = 0.5;  // <|n.s|>, ecology's G for s
  double towards = 0;       // <|n.s| m.s0>, s0 the light's direction
  double lit = 0;           // <|n.s| |m.s0|> over leaves seen from their lit side
  double unlit = 0;         // and over the others

  // For bi-Lambertian leaves with q = (r - t) / (r + t).
  ScatterShares shares(double q) const;
};

// Of at most 2,048 leaves, evenly picked; directions in the tree's frame. Needles point everywhere alike.
LeafScatter leaf_scatter(const Prototype& prototype, const Vec3& look, const Vec3& to_light);

// <(n.s)^2> / <|n.s|> over the leaves, 2/3 for random ones.
double leaf_turn_ratio(const Prototype& prototype, const Vec3& to_light);

}  // namespace sunfleck
