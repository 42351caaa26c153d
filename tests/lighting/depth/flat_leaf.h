// A flat leaf with its area, for scenes whose light is known on paper.
#pragma once

#include <glm/geometric.hpp>

#include "sim/plant/prototype.h"

namespace sunfleck::test {

// The parallelogram centre + a half_u + b half_v, a and b in [-1, 1].
inline FoliageElement flat_leaf(const Vec3& centre, const Vec3& half_u, const Vec3& half_v) {
  FoliageElement e;
  e.centre_m = Vec3f(centre);
  e.half_u_m = Vec3f(half_u);
  e.half_v_m = Vec3f(half_v);
  e.area_m2 = static_cast<float>(4.0 * glm::length(glm::cross(half_u, half_v)));
  return e;
}

}  // namespace sunfleck::test
