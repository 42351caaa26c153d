// Shoots and wood as Embree user geometry. A shoot is a cylinder evenly filled with needles whose normals
// point everywhere alike: a ray meets a needle after an optical depth -ln(1 - u), with half the one-sided
// needle area per volume as extinction; u is hashed from the ray and the shoot.
#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lighting/trace/embree_scene.h"
#include "sim/base/random.h"

namespace sunfleck::trace {

void set_bounds(RTCBounds& to, const Box& box) {
  // One step outwards of single precision on every side.
  const auto down = [](double x) { return std::nextafter(static_cast<float>(x), -INFINITY); };
  const auto up = [](double x) { return std::nextafter(static_cast<float>(x), INFINITY); };
  to.lower_x = down(box.lo.x), to.lower_y = down(box.lo.y), to.lower_z = down(box.lo.z);
  to.upper_x = up(box.hi.x), to.upper_y = up(box.hi.y), to.upper_z = up(box.hi.z);
}

void write_hit(RTCRayHit& to, double t, const Vec3& normal, unsigned slot, unsigned primitive,
               unsigned copy) {
  to.ray.tfar = static_cast<float>(t);
  to.hit.Ng_x = static_cast<float>(normal.x);
  to.hit.Ng_y = static_cast<float>(normal.y);
  to.hit.Ng_z = static_cast<float>(normal.z);
  to.hit.u = to.hit.v = 0.0f;
  to.hit.geomID = slot;
  to.hit.primID = primitive;
  to.hit.instID[0] = copy;
}

double lot_of(const RayContext& context, unsigned copy, unsigned primitive) {
  const std::uint64_t lot = mix_seed(context.ray_key, (std::uint64_t{copy} << 32) | primitive);
  return static_cast<double>(lot >> 11) * 0x1p-53;
}

void attach_solids(const Target& to, PrototypeScene& out, Slot slot, std::size_t count,
                   const Callbacks& callbacks) {
  const RTCGeometry geometry = rtcNewGeometry(to.device.get(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(count));
  rtcSetGeometryUserData(geometry, &out);
  rtcSetGeometryBoundsFunction(geometry, callbacks.bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, callbacks.intersect);
  rtcSetGeometryOccludedFunction(geometry, callbacks.occluded);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(to.scene, geometry, to.first_id + slot);
  rtcReleaseGeometry(geometry);
}

namespace {

Vec3 origin_of(const RTCRay& ray) { return {ray.org_x, ray.org_y, ray.org_z}; }
Vec3 direction_of(const RTCRay& ray) { return {ray.dir_x, ray.dir_y, ray.dir_z}; }

// Distance to the needle met, or infinity.
double needle_distance(const RayContext& context, const PrototypeScene& prototype, unsigned primitive,
                       const RTCRay& ray) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const unsigned copy = copy_met(prototype, context.embree.instID[0]);
  if (is_passed(context, copy)) return kNever;
  const ShootVolume& shoot = prototype.shoots[primitive];
  const Vec3 direction = direction_of(ray);  // in tree coordinates: as long as 1 / scale
  const auto span = inside(shoot.cylinder, origin_of(ray), direction);
  if (!span) return kNever;
  const double enter = std::max(span->enter, static_cast<double>(ray.tnear));
  const double u = lot_of(context, copy, primitive);
  const double met = enter - std::log1p(-u) / (shoot.extinction_per_m * glm::length(direction));
  return met < span->leave && met < static_cast<double>(ray.tfar) ? met : kNever;
}

std::optional<ConeHit> wood_hit(const RayContext& context, const PrototypeScene& prototype,
                                unsigned primitive, const RTCRay& ray) {
  const ConeFrustum& cone = prototype.cones[primitive];
  const unsigned copy = copy_met(prototype, context.embree.instID[0]);
  if (is_passed(context, copy)) return std::nullopt;
  if (is_start(context, copy, HitKind::kWood, primitive)) {
    if (context.from.front) return std::nullopt;  // convex: rays leave its outer side for good
    return leave(cone, origin_of(ray), direction_of(ray), ray.tfar);
  }
  return intersect(cone, origin_of(ray), direction_of(ray), ray.tnear, ray.tfar);
}

const RayContext& context_of(const RTCIntersectContext* context) {
  return *reinterpret_cast<const RayContext*>(context);
}

void shoot_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& prototype = *static_cast<const PrototypeScene*>(args->geometryUserPtr);
  const Cylinder& c = prototype.shoots[args->primID].cylinder;
  const Vec3 reach =
      c.half_length * glm::abs(c.axis) + c.radius * glm::sqrt(glm::max(Vec3(0), 1.0 - c.axis * c.axis));
  set_bounds(*args->bounds_o, {c.centre - reach, c.centre + reach});
}

void shoot_intersect(const RTCIntersectFunctionNArguments* args) {
  if (!args->valid[0]) return;
  auto& rayhit = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  const RayContext& context = context_of(args->context);
  const auto& prototype = *static_cast<const PrototypeScene*>(args->geometryUserPtr);
  const double t = needle_distance(context, prototype, args->primID, rayhit.ray);
  if (std::isfinite(t))
    write_hit(rayhit, t, -direction_of(rayhit.ray), args->geomID, args->primID, context.embree.instID[0]);
}

void shoot_occluded(const RTCOccludedFunctionNArguments* args) {
  if (!args->valid[0]) return;
  auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
  const auto& prototype = *static_cast<const PrototypeScene*>(args->geometryUserPtr);
  if (std::isfinite(needle_distance(context_of(args->context), prototype, args->primID, ray)))
    ray.tfar = -std::numeric_limits<float>::infinity();
}

void cone_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& prototype = *static_cast<const PrototypeScene*>(args->geometryUserPtr);
  const ConeFrustum& c = prototype.cones[args->primID];
  const Vec3 rim = glm::sqrt(glm::max(Vec3(0), 1.0 - c.axis * c.axis));
  Box box;
  for (const double h : {0.0, c.length}) {
    const Vec3 p = c.base + h * c.axis, reach = (c.radius_at_base + c.taper * h) * rim;
    box.include(p - reach);
    box.include(p + reach);
  }
  set_bounds(*args->bounds_o, box);
}

void cone_intersect(const RTCIntersectFunctionNArguments* args) {
  if (!args->valid[0]) return;
  auto& rayhit = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  const RayContext& context = context_of(args->context);
  const auto& prototype = *static_cast<const PrototypeScene*>(args->geometryUserPtr);
  if (const auto hit = wood_hit(context, prototype, args->primID, rayhit.ray))
    write_hit(rayhit, hit->t, hit->outward_normal, args->geomID, args->primID, context.embree.instID[0]);
}

void cone_occluded(const RTCOccludedFunctionNArguments* args) {
  if (!args->valid[0]) return;
  auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
  const auto& prototype = *static_cast<const PrototypeScene*>(args->geometryUserPtr);
  if (wood_hit(context_of(args->context), prototype, args->primID, ray))
    ray.tfar = -std::numeric_limits<float>::infinity();
}

ShootVolume volume_of(const FoliageElement& e, const Placement& placement) {
  const Vec3 u(e.half_u_m);
  const double scale = placement.scale(), half_length = scale * glm::length(u),
               radius = scale * glm::length(Vec3(e.half_v_m));
  const double volume_m3 = 2.0 * half_length * kPi * radius * radius;
  const Vec3 axis = half_length > 0.0 ? glm::normalize(u) : Vec3(0, 0, 1);
  ShootVolume shoot;
  shoot.cylinder = {placement.point(Vec3(e.centre_m)), placement.direction(axis), half_length, radius};
  shoot.extinction_per_m = volume_m3 > 0.0 ? 0.5 * scale * scale * e.area_m2 / volume_m3 : 0.0;
  return shoot;
}

}  // namespace

void add_shoots(const Target& to, const Prototype& prototype, PrototypeScene& out) {
  if (out.shoot_elements.empty()) return;
  for (const std::uint32_t i : out.shoot_elements)
    out.shoots.push_back(volume_of(prototype.foliage[i], to.placement));
  attach_solids(to, out, kShoots, out.shoots.size(), {shoot_bounds, shoot_intersect, shoot_occluded});
}

void add_wood_cones(const Target& to, const Prototype& prototype, PrototypeScene& out) {
  if (prototype.wood.empty()) return;
  const double scale = to.placement.scale();
  for (const WoodSegment& s : prototype.wood)
    out.cones.push_back(cone_between(to.placement.point(Vec3(s.from_m)), to.placement.point(Vec3(s.to_m)),
                                     scale * s.radius_from_m, scale * s.radius_to_m));
  attach_solids(to, out, kWoodCones, out.cones.size(), {cone_bounds, cone_intersect, cone_occluded});
}

}  // namespace sunfleck::trace
