#include "lighting/trace/surface_sampler.h"

#include <algorithm>
#include <cmath>

namespace sunfleck::trace {
namespace {

Vec3 unit_or_up(const Vec3& v) {
  const double length = glm::length(v);
  return length > 0.0 ? v / length : Vec3(0, 0, 1);
}

double side_area_m2(const ConeFrustum& cone) {
  const double r0 = cone.radius_at_base, r1 = r0 + cone.taper * cone.length;
  return kPi * (r0 + r1) * std::hypot(cone.length, r1 - r0);
}

// Even over the side of a frustum: the area below height h grows with radius^2.
SurfacePoint on_side(const ConeFrustum& cone, double part, double turn) {
  const double r0 = cone.radius_at_base, r1 = r0 + cone.taper * cone.length;
  const double radius = std::sqrt(std::max(0.0, r0 * r0 + part * (r1 * r1 - r0 * r0)));
  const double height =
      std::abs(r1 - r0) > 1e-9 * (r0 + r1) ? (radius - r0) / cone.taper : part * cone.length;
  const Basis basis = basis_around(cone.axis);
  const Vec3 spoke = std::cos(turn) * basis.tangent + std::sin(turn) * basis.bitangent;
  return {cone.base + height * cone.axis + radius * spoke, glm::normalize(spoke - cone.taper * cone.axis), 0};
}

}  // namespace

SurfaceSampler::SurfaceSampler(const Receivers& receivers, std::size_t surface)
    : object_(receivers.object(surface)) {
  if (object_.kind == HitKind::kGround)
    take_ground(receivers);
  else if (object_.kind == HitKind::kFoliage)
    take_element(world_element(receivers.forest(), object_.instance, object_.local));
  else
    take_wood(receivers);
}

void SurfaceSampler::take_element(const WorldElement& e) {
  origin_ = e.centre_m;
  u_ = e.half_u_m;
  v_ = e.half_v_m;
  normal_ = unit_or_up(glm::cross(u_, v_));
  switch (e.shape) {
    case ElementShape::kParallelogram:
      shape_ = Shape::kParallelogram;
      break;
    case ElementShape::kDisc:
      shape_ = Shape::kDisc;
      break;
    case ElementShape::kTriangle:
      shape_ = Shape::kTriangle;
      origin_ -= (u_ + v_) / 3.0;
      break;
    case ElementShape::kShoot: {
      shape_ = Shape::kShoot;
      const double radius = glm::length(v_);
      const Basis basis = basis_around(unit_or_up(u_));
      v_ = radius * basis.tangent;
      w_ = radius * basis.bitangent;
    }
  }
}

void SurfaceSampler::take_wood(const Receivers& receivers) {
  const Instance& instance = receivers.forest().instances[object_.instance];
  const Prototype& prototype = receivers.forest().prototypes[instance.prototype.value];
  const double scale = instance.scale;
  if (object_.kind == HitKind::kWood) {
    shape_ = Shape::kCone;
    const SegmentRange group = receivers.wood_group(instance.prototype, object_.local);
    double area_m2 = 0.0;
    for (std::uint32_t i = group.first; i < group.end; ++i) {
      const WoodSegment& s = prototype.wood[i];
      cones_.push_back(cone_between(world_from_tree(instance, s.from_m), world_from_tree(instance, s.to_m),
                                    scale * s.radius_from_m, scale * s.radius_to_m));
      area_up_to_m2_.push_back(area_m2 += side_area_m2(cones_.back()));
    }
    return;
  }
  const WoodTriangle& t = prototype.wood_mesh[object_.local];
  shape_ = Shape::kTriangle;
  origin_ = world_from_tree(instance, t.a_m);
  u_ = world_from_tree(instance, t.b_m) - origin_;
  v_ = world_from_tree(instance, t.c_m) - origin_;
  normal_ = unit_or_up(glm::cross(u_, v_));
}

void SurfaceSampler::take_ground(const Receivers& receivers) {
  const GroundCells& ground = receivers.ground();
  const Terrain& terrain = receivers.forest().terrain;
  const Vec2 lo = ground.lo_m + ground.cell_m * Vec2(object_.local % ground.nx, object_.local / ground.nx);
  const auto at = [&](double x, double y) { return Vec3(x, y, terrain.height_at(x, y)); };
  origin_ = at(lo.x + 0.5 * ground.cell_m.x, lo.y + 0.5 * ground.cell_m.y);
  u_ = 0.5 * (at(lo.x + ground.cell_m.x, lo.y) - at(lo.x, lo.y));
  v_ = 0.5 * (at(lo.x, lo.y + ground.cell_m.y) - at(lo.x, lo.y));
  normal_ = ground.normal;
}

// The segment whose share of the group's area holds `part`, and the same number again stretched over it.
SurfacePoint SurfaceSampler::sample_wood(double part, double turn) const {
  const double wanted_m2 = part * area_up_to_m2_.back();
  const auto found = std::upper_bound(area_up_to_m2_.begin(), area_up_to_m2_.end(), wanted_m2);
  const auto i = std::min(static_cast<std::size_t>(found - area_up_to_m2_.begin()), cones_.size() - 1);
  const double before_m2 = i > 0 ? area_up_to_m2_[i - 1] : 0.0, own_m2 = area_up_to_m2_[i] - before_m2;
  SurfacePoint point =
      on_side(cones_[i], own_m2 > 0.0 ? std::clamp((wanted_m2 - before_m2) / own_m2, 0.0, 1.0) : 0.5, turn);
  point.local = object_.local + static_cast<std::uint32_t>(i);
  return point;
}

RayStart SurfaceSampler::start(const SurfacePoint& point, bool front) const {
  if (is_shoot()) return {};  // a ray from a needle may meet other needles of its own shoot
  return {object_.kind, front, object_.instance, point.local};
}

SurfacePoint SurfaceSampler::sample(RandomStream& random) const {
  const double a = random.uniform(), b = random.uniform();
  SurfacePoint point = sample_at(a, b, is_shoot() ? random.uniform() : 0.0);
  if (is_shoot()) point.normal = any_direction(random);
  return point;
}

SurfacePoint SurfaceSampler::sample_at(double a, double b, double c) const {
  switch (shape_) {
    case Shape::kParallelogram:
      return {origin_ + (2.0 * a - 1.0) * u_ + (2.0 * b - 1.0) * v_, normal_, object_.local};
    case Shape::kDisc: {
      const double r = std::sqrt(a), turn = 2.0 * kPi * b;
      return {origin_ + r * std::cos(turn) * u_ + r * std::sin(turn) * v_, normal_, object_.local};
    }
    case Shape::kTriangle: {
      const double s = std::sqrt(a);
      return {origin_ + s * (1.0 - b) * u_ + s * b * v_, normal_, object_.local};
    }
    case Shape::kCone:
      return sample_wood(a, 2.0 * kPi * b);
    case Shape::kShoot:
      break;
  }
  const double r = std::sqrt(b), turn = 2.0 * kPi * c;
  const Vec3 across = r * std::cos(turn) * v_ + r * std::sin(turn) * w_;
  return {origin_ + (2.0 * a - 1.0) * u_ + across, unit_or_up(u_), object_.local};
}

}  // namespace sunfleck::trace
