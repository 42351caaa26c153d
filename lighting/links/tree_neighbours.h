// Which other trees, or copies of a tree in a periodic forest, reach into the space of one instance: where
// they do, a link within the tree may be cut.
#pragma once

#include <vector>

#include "sim/forest/forest.h"

namespace sunfleck::links {

class TreeNeighbours {
 public:
  // Every tree is taken as the upright cylinder round its stem that holds it.
  TreeNeighbours(const Forest& forest, std::size_t instance);

  bool any() const { return !reaching_in_.empty(); }
  // False only if no neighbour can stand between two points.
  bool may_cut(const Vec3& from_m, const Vec3& to_m) const;

 private:
  struct Cylinder {
    Vec2 axis_m{0};
    double radius_m = 0, lo_m = 0, hi_m = 0;
  };
  static Cylinder around(const Forest& forest, std::size_t instance);
  static bool touch(const Cylinder& a, const Cylinder& b);

  std::vector<Cylinder> reaching_in_;
};

}  // namespace sunfleck::links
