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

namespace {

// A line against the endless cone of a frustum, from the point of the line nearest to the base, so that far
// origins cost no digits.
class LineThroughCone {
 public:
  LineThroughCone(const ConeFrustum& cone, const Vec3& origin, const Vec3& direction)
      : cone_(cone),
        direction_(direction),
        t_near_(glm::dot(cone.base - origin, direction) / glm::dot(direction, direction)) {
    const Vec3 o = origin + t_near_ * direction - cone.base;
    height_ = glm::dot(o, cone.axis);
    rise_ = glm::dot(direction, cone.axis);
    across_ = o - height_ * cone.axis;
    run_ = direction - rise_ * cone.axis;
    radius_ = cone.radius_at_base + cone.taper * height_;
    widening_ = cone.taper * rise_;
  }

  // |across + t run|^2 = (radius + t widening)^2
  std::optional<Span> crossings() const {
    return roots(glm::dot(run_, run_) - widening_ * widening_, glm::dot(across_, run_) - radius_ * widening_,
                 glm::dot(across_, across_) - radius_ * radius_);
  }

  // The crossing at `t` (from the nearest point) if it lies on the frustum's side with a distance in range.
  std::optional<ConeHit> hit(double t, double t_min, double t_max) const {
    const double h = height_ + t * rise_;
    if (!(t + t_near_ > t_min && t + t_near_ < t_max && h >= 0.0 && h <= cone_.length)) return std::nullopt;
    if (radius_ + t * widening_ < 0.0) return std::nullopt;  // the mirror cone beyond the tip
    const Vec3 spoke = across_ + t * run_;
    const double spoke_length = glm::length(spoke);
    if (!(spoke_length > 0.0)) return std::nullopt;
    const Vec3 normal = glm::normalize(spoke / spoke_length - cone_.taper * cone_.axis);
    return ConeHit{t + t_near_, normal, glm::dot(normal, direction_) < 0.0};
  }

 private:
  const ConeFrustum& cone_;
  Vec3 direction_;
  double t_near_, height_ = 0, rise_ = 0, radius_ = 0, widening_ = 0;
  Vec3 across_{0}, run_{0};
};

}  // namespace

std::optional<ConeHit> intersect(const ConeFrustum& cone, const Vec3& origin, const Vec3& direction,
                                 double t_min, double t_max) {
  if (!(cone.length > 0.0)) return std::nullopt;
  const LineThroughCone line(cone, origin, direction);
  const auto both = line.crossings();
  if (!both) return std::nullopt;
  const auto near_hit = line.hit(both->enter, t_min, t_max);
  return near_hit ? near_hit : line.hit(both->leave, t_min, t_max);
}

std::optional<ConeHit> leave(const ConeFrustum& cone, const Vec3& origin, const Vec3& direction,
                             double t_max) {
  if (!(cone.length > 0.0)) return std::nullopt;
  const LineThroughCone line(cone, origin, direction);
  const auto both = line.crossings();
  return both ? line.hit(both->leave, 0.0, t_max) : std::nullopt;
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
