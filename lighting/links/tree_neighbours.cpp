#include "lighting/links/tree_neighbours.h"

#include <algorithm>
#include <cmath>

namespace sunfleck::links {

TreeNeighbours::Cylinder TreeNeighbours::around(const Forest& forest, std::size_t instance) {
  const Instance& i = forest.instances[instance];
  const Prototype& tree = forest.prototypes[i.prototype.value];
  const Box box = prototype_bounds(tree);
  const double scale = i.scale;
  if (box.empty()) return {{i.position_m.x, i.position_m.y}, 0.0, i.position_m.z, i.position_m.z};
  return {{i.position_m.x, i.position_m.y},
          scale * prototype_reach_m(tree),
          i.position_m.z + scale * box.lo.z,
          i.position_m.z + scale * box.hi.z};
}

bool TreeNeighbours::touch(const Cylinder& a, const Cylinder& b) {
  return glm::length(a.axis_m - b.axis_m) <= a.radius_m + b.radius_m && a.lo_m <= b.hi_m && b.lo_m <= a.hi_m;
}

TreeNeighbours::TreeNeighbours(const Forest& forest, std::size_t instance) {
  const Cylinder own = around(forest, instance);
  for (std::size_t j = 0; j < forest.instances.size(); ++j) {
    const Cylinder other = around(forest, j);
    if (!forest.period) {
      if (j != instance && touch(own, other)) reaching_in_.push_back(other);
      continue;
    }
    const Vec2 size = forest.period->size_m, apart = own.axis_m - other.axis_m;
    const double reach = own.radius_m + other.radius_m;
    const auto first = [&](double d, double s) { return static_cast<int>(std::ceil((d - reach) / s)); };
    const auto last = [&](double d, double s) { return static_cast<int>(std::floor((d + reach) / s)); };
    for (int x = first(apart.x, size.x); x <= last(apart.x, size.x); ++x)
      for (int y = first(apart.y, size.y); y <= last(apart.y, size.y); ++y) {
        if (j == instance && x == 0 && y == 0) continue;
        Cylinder copy = other;
        copy.axis_m += Vec2(x * size.x, y * size.y);
        // Copies follow the ground.
        const double lift = forest.terrain.height_at(copy.axis_m.x, copy.axis_m.y) -
                            forest.terrain.height_at(other.axis_m.x, other.axis_m.y);
        copy.lo_m += lift;
        copy.hi_m += lift;
        if (touch(own, copy)) reaching_in_.push_back(copy);
      }
  }
}

bool TreeNeighbours::may_cut(const Vec3& from_m, const Vec3& to_m) const {
  const Vec2 from(from_m.x, from_m.y), way = Vec2(to_m.x, to_m.y) - from;
  const double length2 = std::max(glm::dot(way, way), 1e-300);
  const double lo_m = std::min(from_m.z, to_m.z), hi_m = std::max(from_m.z, to_m.z);
  for (const Cylinder& c : reaching_in_) {
    if (hi_m < c.lo_m || lo_m > c.hi_m) continue;
    const Vec2 to_axis = c.axis_m - from;
    const double nearest = std::clamp(glm::dot(to_axis, way) / length2, 0.0, 1.0);
    if (glm::length(to_axis - nearest * way) <= c.radius_m) return true;
  }
  return false;
}

}  // namespace sunfleck::links
