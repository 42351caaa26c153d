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

TreeNeighbours::TreeNeighbours(const Forest& forest, std::size_t instance) : own_(around(forest, instance)) {
  for (std::size_t j = 0; j < forest.instances.size(); ++j) {
    const Cylinder other = around(forest, j);
    if (!forest.period) {
      if (j != instance && touch(own_, other)) reaching_in_.push_back(other);
      continue;
    }
    const Vec2 size = forest.period->size_m, apart = own_.axis_m - other.axis_m;
    const double reach = own_.radius_m + other.radius_m;
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
        if (touch(own_, copy)) reaching_in_.push_back(copy);
      }
  }
}

bool TreeNeighbours::may_cut(const Vec3& origin_m, const Vec3& direction) const {
  // The way to the own cylinder's side and ends, at most.
  const Vec2 from = Vec2(origin_m.x, origin_m.y) - own_.axis_m, d(direction.x, direction.y);
  double far_m = own_.hi_m - own_.lo_m + 2.0 * own_.radius_m;
  const double level2 = glm::dot(d, d), along = glm::dot(from, d);
  const double inside = along * along + level2 * (own_.radius_m * own_.radius_m - glm::dot(from, from));
  if (level2 > 1e-12 && inside >= 0.0) far_m = std::min(far_m, (std::sqrt(inside) - along) / level2);
  if (direction.z > 1e-12) far_m = std::min(far_m, (own_.hi_m - origin_m.z) / direction.z);
  if (direction.z < -1e-12) far_m = std::min(far_m, (own_.lo_m - origin_m.z) / direction.z);
  const double end_z = origin_m.z + far_m * direction.z;
  for (const Cylinder& c : reaching_in_) {
    if (std::max(origin_m.z, end_z) < c.lo_m || std::min(origin_m.z, end_z) > c.hi_m) continue;
    const Vec2 to_axis = c.axis_m - Vec2(origin_m.x, origin_m.y);
    const double nearest_m = level2 > 1e-12 ? std::clamp(glm::dot(to_axis, d) / level2, 0.0, far_m) : 0.0;
    if (glm::length(to_axis - nearest_m * d) <= c.radius_m) return true;
  }
  return false;
}

}  // namespace sunfleck::links
