// See grid_frame.h.
#include "lighting/depth/grid_frame.h"

#include <cmath>

namespace sunfleck {

Vec3 GridFrame::unwrapped_from_world(const Vec3& point_m) const {
  Vec3 p = point_m - origin_m;
  p.z -= shear.x * p.x + shear.y * p.y;
  return p;
}

Vec3 GridFrame::field_from_world(const Vec3& point_m) const {
  Vec3 p = unwrapped_from_world(point_m);
  if (period_m) {
    p.x -= period_m->x * std::floor(p.x / period_m->x);
    p.y -= period_m->y * std::floor(p.y / period_m->y);
  }
  return p;
}

Vec3 GridFrame::field_direction(const Vec3& direction) const {
  return {direction.x, direction.y, direction.z - shear.x * direction.x - shear.y * direction.y};
}

bool GridFrame::ends_on_ground(const Vec3& direction) const {
  return glm::dot(direction, ground_normal) <= 0.0;
}

std::optional<Box> GridFrame::period_box() const {
  if (!period_m) return std::nullopt;
  Box box;
  box.include(Vec3(0.0));
  box.include(Vec3(period_m->x, period_m->y, 0.0));
  return box;
}

GridFrame grid_frame(const Forest& forest) {
  GridFrame frame;
  const Vec3 n = forest.terrain.normal();
  frame.ground_normal = n;
  frame.origin_m = forest_bounds(forest).centre();
  if (!forest.period) return frame;
  frame.period_m = forest.period->size_m;
  frame.origin_m.x = forest.period->origin_m.x;
  frame.origin_m.y = forest.period->origin_m.y;
  frame.shear = Vec2(-n.x / n.z, -n.y / n.z);
  return frame;
}

}  // namespace sunfleck
