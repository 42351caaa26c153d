// Trees to records of a picture.
#pragma once

#include <cstddef>

#include "lighting/trace/raster_shapes.h"

namespace sunfleck::trace {

// A tree's place in the picture: pixel coordinates and depth as rows over tree coordinates.
struct PlacedTree {
  std::uint32_t instance = 0;
  Vec3 u_per_m{0}, v_per_m{0}, s_per_m{0};
  double u = 0, v = 0, s = 0;  // of the stem foot
  PixelBox bounds;             // of all of it, before wrapping
};
PlacedTree place_tree(const RasterView& view, const Forest& forest, std::size_t instance, const Box& box);

// How much of a picture a tree of these bounds touches, all wrapped copies counted.
bool touches(const RasterView& view, const PixelBox& bounds, const PixelBox& part);

// Appends the records of foliage [first, end) whose bounds touch `part` of the picture, wrapped copies as
// records of their own. `first_element`: of the instance in ForestIndex order.
void project_foliage(const RasterView& view, const Forest& forest, const PlacedTree& tree,
                     std::size_t first_element, std::size_t first, std::size_t end, const PixelBox& part,
                     RasterScene& out);
void project_wood(const RasterView& view, const Forest& forest, const PlacedTree& tree, const PixelBox& part,
                  RasterScene& out);

}  // namespace sunfleck::trace
