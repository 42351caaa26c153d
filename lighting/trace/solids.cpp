#include "lighting/trace/solids.h"

#include <algorithm>
#include <cmath>

namespace sunfleck::trace {
namespace {

// Roots of a t^2 + 2 b t + c = 0 in rising order, by the form that does not cancel.
std::optional<Span> roots(double a, double b, double c) {
  if (a == 0.0) {
    if (b == 0.0) return std::nullopt;
    const double t = -c / (2.0 * b);
    return Span{t, t};
  }
  const double discriminant = b * b - a * c;
  if (!(discriminant >= 0.0)) return std::nullopt;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  const double t0 = q / a, t1 = q == 0.0 ? t0 : c / q;
  return Span{std::min(t0, t1), std::max(t0, t1)};
}

}  // namespace

ConeFrustum cone_between(const Vec3& from, const Vec3& to, double radius_from, double radius_to) {
  const double length = glm::length(to - from);
  if (!(length > 0.0)) return {from, Vec3(0, 0, 1), 0.0, radius_from, 0.0};
  return {from, (to - from) / length, length, radius_from, (radius_to - radius_from) / length};
}

std::optional<ConeHit> intersect(const ConeFrustum& cone, const Vec3& origin, const Vec3& direction,
                                 double t_min, double t_max) {
  if (!(cone.length > 0.0)) return std::nullopt;
  // Start from the point nearest to the base, so that far origins cost no digits.
  const double t_near = glm::dot(cone.base - origin, direction) / glm::dot(direction, direction);
  const Vec3 o = origin + t_near * direction - cone.base;
  const double height = glm::dot(o, cone.axis), rise = glm::dot(direction, cone.axis);
  const Vec3 across = o - height * cone.axis, run = direction - rise * cone.axis;
  const double radius = cone.radius_at_base + cone.taper * height, widening = cone.taper * rise;
  // |across + t run|^2 = (radius + t widening)^2
  const auto both = roots(glm::dot(run, run) - widening * widening, glm::dot(across, run) - radius * widening,
                          glm::dot(across, across) - radius * radius);
  if (!both) return std::nullopt;
  for (const double t : {both->enter, both->leave}) {
    const double h = height + t * rise;
    if (!(t + t_near > t_min && t + t_near < t_max && h >= 0.0 && h <= cone.length)) continue;
    if (radius + t * widening < 0.0) continue;  // the mirror cone beyond the tip
    const Vec3 spoke = across + t * run;
    const double spoke_length = glm::length(spoke);
    if (!(spoke_length > 0.0)) continue;
    const Vec3 normal = glm::normalize(spoke / spoke_length - cone.taper * cone.axis);
    return ConeHit{t + t_near, normal, glm::dot(normal, direction) < 0.0};
  }
  return std::nullopt;
}

std::optional<Span> inside(const Cylinder& cylinder, const Vec3& origin, const Vec3& direction) {
  const double t_near = glm::dot(cylinder.centre - origin, direction) / glm::dot(direction, direction);
  const Vec3 o = origin + t_near * direction - cylinder.centre;
  const double height = glm::dot(o, cylinder.axis), rise = glm::dot(direction, cylinder.axis);
  const Vec3 across = o - height * cylinder.axis, run = direction - rise * cylinder.axis;
  const double run2 = glm::dot(run, run),
               miss2 = glm::dot(across, across) - cylinder.radius * cylinder.radius;
  Span span{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  if (run2 > 0.0) {
    const auto side = roots(run2, glm::dot(across, run), miss2);
    if (!side) return std::nullopt;
    span = *side;
  } else if (miss2 > 0.0) {
    return std::nullopt;
  }
  if (rise != 0.0) {
    const double a = (-cylinder.half_length - height) / rise, b = (cylinder.half_length - height) / rise;
    span.enter = std::max(span.enter, std::min(a, b));
    span.leave = std::min(span.leave, std::max(a, b));
  } else if (std::abs(height) > cylinder.half_length) {
    return std::nullopt;
  }
  if (!(span.enter < span.leave)) return std::nullopt;
  return Span{span.enter + t_near, span.leave + t_near};
}

}  // namespace sunfleck::trace
