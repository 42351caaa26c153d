// Leaves scattered at random the way a crown has them: what shadow masks are made from ([LeafMask]:
// "generated with only the parameters of the leaf distribution"). Positions are independent, turned every way
// alike; sizes and shapes are drawn from the crown. Not clumped: how much light arrives comes from elsewhere
// (grid march or thickness), a mask only says which points get it.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/base/random.h"
#include "sim/plant/prototype.h"

namespace sunfleck {

// A few thousand leaf shapes and how dense they stand.
struct MaskLeaves {
  struct Leaf {
    double half_u_m = 0.05, half_v_m = 0.05;
    ElementShape shape = ElementShape::kParallelogram;
    double cover = 1;  // share of its outline that stops light: 1 but for shoots
  };
  std::vector<Leaf> leaf;
  double mean_area_m2 = 0;   // of the outlines
  double mean_cover_m2 = 0;  // area that stops light
  double per_m3 = 0;         // leaves per volume of the crown's ellipsoid
  double side_m() const;     // of a square of the mean area
  double extinction_per_m() const { return 0.5 * per_m3 * mean_cover_m2; }  // tau
};

// From a crown's foliage (at most 4096 elements, evenly picked). Throws Error(kInvalidInput) that names
// `where` if there is none, or all of it has no area.
MaskLeaves mask_leaves(const Prototype& crown, const char* where);

// One leaf turned at random.
struct PlacedLeaf {
  Vec3 centre{0}, half_u{0}, half_v{0}, normal{0};
  ElementShape shape = ElementShape::kParallelogram;
  double cover = 1;
};
PlacedLeaf place_leaf(const MaskLeaves& leaves, const Vec3& centre, RandomStream& random);

// True if the point centre + a half_u + b half_v belongs to a leaf of this shape.
bool leaf_covers(ElementShape shape, double a, double b);

}  // namespace sunfleck
