// How far a prototype reaches from its stem axis: corners of flat elements exactly, rims of discs, shoots and
// wood as if they lay level (too far by a part of their own radius).
#include <algorithm>
#include <cmath>

#include "sim/plant/prototype.h"

namespace sunfleck {
namespace {

constexpr double kRounding = 1e-6;

// Coordinates are floats, whose squares do not leave the range of doubles.
double from_axis(const Vec3& point) { return std::sqrt(point.x * point.x + point.y * point.y); }

double element_reach(const FoliageElement& e) {
  const Vec3 centre(e.centre_m), u(e.half_u_m), v(e.half_v_m);
  switch (e.shape) {
    case ElementShape::kParallelogram:
      return std::max({from_axis(centre + u + v), from_axis(centre + u - v), from_axis(centre - u + v),
                       from_axis(centre - u - v)});
    case ElementShape::kTriangle: {
      const Vec3 corner = centre - (u + v) / 3.0;
      return std::max({from_axis(corner), from_axis(corner + u), from_axis(corner + v)});
    }
    case ElementShape::kDisc:
      return from_axis(centre) + std::max(glm::length(u), glm::length(v));
    case ElementShape::kShoot:
      return std::max(from_axis(centre + u), from_axis(centre - u)) + glm::length(v);
  }
  return 0;
}

}  // namespace

double prototype_reach_m(const Prototype& prototype) {
  double reach = 0;
  for (const FoliageElement& e : prototype.foliage) reach = std::max(reach, element_reach(e));
  for (const WoodSegment& s : prototype.wood)
    reach = std::max({reach, from_axis(s.from_m) + s.radius_from_m, from_axis(s.to_m) + s.radius_to_m});
  for (const WoodTriangle& t : prototype.wood_mesh)
    reach = std::max({reach, from_axis(t.a_m), from_axis(t.b_m), from_axis(t.c_m)});
  return reach * (1 + kRounding);
}

}  // namespace sunfleck
