// One leaf laid on the plane that stands for it, and its 16 bytes. Private to the folder.
#pragma once

#include "lighting/shade/billboard_cloud.h"

namespace sunfleck {

// A leaf on its plane.
struct FlatLeaf {
  Vec2 centre{0}, half_u{0}, half_v{0};
  double height = 0;  // over the plane, of the centre
  Vec2 rise{0};       // of the leaf's own plane, per metre
  Vec3 normal{0};     // of the leaf, on the side of the plane's normal
  ElementShape shape = ElementShape::kParallelogram;
};

// The two axes on a plane along which its leaves spread most and least.
Basis spread_axes(std::span<const FoliageElement> foliage, const LeafPlane& plane);

// `turn`: laid flat, area kept; else projected.
FlatLeaf flat_leaf(const FoliageElement& element, const LeafPlane& plane, const Basis& axes, bool turn);

struct Bounds2 {
  Vec2 lo{1e300}, hi{-1e300};
  void include(const Vec2& p) { lo = glm::min(lo, p), hi = glm::max(hi, p); }
};
Bounds2 bounds_of(const FlatLeaf& leaf);

// Whether a point of the plane belongs to the leaf.
bool covers(const FlatLeaf& leaf, const LeafMask& mask, const Vec2& point);

// `corner`: of the rectangle, on the axes of the plane.
LeafRecord packed(const FlatLeaf& leaf, const Billboard& board, const Vec2& corner, double scale_m,
                  const std::array<float, 4>& ambient);

}  // namespace sunfleck
