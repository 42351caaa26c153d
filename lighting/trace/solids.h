// Rays against the two solids that Embree does not know: the side of a cone frustum (wood) and a closed
// cylinder (the cloud of needles of a shoot). Double precision, any direction length.
#pragma once

#include <optional>

#include "sim/base/vec.h"

namespace sunfleck::trace {

// The side of a frustum, without end caps: radius(h) = radius_at_base + taper * h for h in [0, length].
struct ConeFrustum {
  Vec3 base{0}, axis{0, 0, 1};  // axis: unit
  double length = 0, radius_at_base = 0, taper = 0;
};
ConeFrustum cone_between(const Vec3& from, const Vec3& to, double radius_from, double radius_to);

struct ConeHit {
  double t;
  Vec3 outward_normal;  // unit
  bool from_outside;
};
// Nearest point of the side with t in (t_min, t_max).
std::optional<ConeHit> intersect(const ConeFrustum& cone, const Vec3& origin, const Vec3& direction,
                                 double t_min, double t_max);

// Where a ray that starts on the inner side leaves the side again: the farther of the two points of the line,
// so that a start off the surface by rounding cannot meet the outer side it never came from.
std::optional<ConeHit> leave(const ConeFrustum& cone, const Vec3& origin, const Vec3& direction,
                             double t_max);

struct Cylinder {
  Vec3 centre{0}, axis{0, 0, 1};  // axis: unit
  double half_length = 0, radius = 0;
};
struct Span {
  double enter, leave;
};
// The part of the line inside the cylinder (caps included), not clipped to t >= 0.
std::optional<Span> inside(const Cylinder& cylinder, const Vec3& origin, const Vec3& direction);

}  // namespace sunfleck::trace
