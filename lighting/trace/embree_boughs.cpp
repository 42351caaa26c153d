// Shoots as boughs in closed form: a ray meets a needle of one after an optical depth -ln(1 - u), u hashed
// from the ray and the shoot. Whether it does is decided by the quick form alone, so that shadow rays and
// others agree; where, by the exact one.
#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lighting/shade/bough_light.h"
#include "lighting/shade/bough_quick.h"
#include "lighting/trace/embree_scene.h"

namespace sunfleck::trace {
namespace {

const PrototypeScene& prototype_of(void* pointer) { return *static_cast<const PrototypeScene*>(pointer); }

double top_of(const BoughVolume& v) { return v.highest + v.outer_radius * v.cos_aperture / v.sin_aperture; }

void bough_bounds(const RTCBoundsFunctionArguments* args) {
  const ShootBough& b = prototype_of(args->geometryUserPtr).boughs[args->primID];
  const Vec3 wide = b.volume.outer_radius * glm::sqrt(glm::max(Vec3(0), 1.0 - b.axis * b.axis));
  Box box;
  for (const double z : {b.volume.lowest, top_of(b.volume)}) {
    box.include(b.origin_m + z * b.axis - wide);
    box.include(b.origin_m + z * b.axis + wide);
  }
  set_bounds(*args->bounds_o, box);
}

// A ray in the bough's frame, from its nearest distance on; lengths are those of the prototype's scene.
struct Met {
  bool met = false;
  double before = 0, per_t = 1;  // of the ray: distance = before + t * per_t
  QuickCrossing crossing;
  Vec3 origin{0}, direction{0};
  double lot = 0;
};

Met meets(const RayContext& context, const PrototypeScene& prototype, unsigned primitive, const RTCRay& ray) {
  Met m;
  const unsigned copy = copy_met(prototype, context.embree.instID[0]);
  if (is_passed(context, copy)) return m;
  const ShootBough& b = prototype.boughs[primitive];
  const Vec3 way(ray.dir_x, ray.dir_y, ray.dir_z);
  m.per_t = glm::length(way);
  m.direction = b.into_bough(way / m.per_t);
  m.before = static_cast<double>(ray.tnear) * m.per_t;
  m.origin = b.into_bough(Vec3(ray.org_x, ray.org_y, ray.org_z) - b.origin_m) + m.before * m.direction;
  const double far = static_cast<double>(ray.tfar) * m.per_t - m.before;
  m.crossing = quick_crossing(quick_bough(b.volume), Vec3f(m.origin), Vec3f(m.direction), 0.0f,
                              static_cast<float>(std::min(far, 1e30)));
  m.lot = lot_of(context, copy, primitive);
  m.met = -std::log1p(-m.lot) < static_cast<double>(m.crossing.depth);
  return m;
}

void bough_intersect(const RTCIntersectFunctionNArguments* args) {
  if (!args->valid[0]) return;
  auto& rayhit = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  const auto& context = *reinterpret_cast<const RayContext*>(args->context);
  const PrototypeScene& prototype = prototype_of(args->geometryUserPtr);
  const Met m = meets(context, prototype, args->primID, rayhit.ray);
  if (!m.met) return;
  const ShootBough& b = prototype.boughs[args->primID];
  const auto event = bough_event(b.volume, m.origin, bough_direction(b.volume, m.direction), m.lot);
  const double leave = static_cast<double>(m.crossing.leave);
  const double at = event ? std::min(event->distance, leave) : leave;
  const Vec3 p = m.origin + at * m.direction;
  const double rho = std::hypot(p.x, p.y), out = b.volume.sin_aperture / std::max(rho, 1e-12);
  const Vec3 axis = b.out_of_bough(Vec3(out * p.x, out * p.y, b.volume.cos_aperture));
  write_hit(rayhit, (m.before + at) / m.per_t, axis, args->geomID, args->primID, context.embree.instID[0]);
}

void bough_occluded(const RTCOccludedFunctionNArguments* args) {
  if (!args->valid[0]) return;
  auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
  const auto& context = *reinterpret_cast<const RayContext*>(args->context);
  if (meets(context, prototype_of(args->geometryUserPtr), args->primID, ray).met)
    ray.tfar = -std::numeric_limits<float>::infinity();
}

ShootBough placed(ShootBough b, const Placement& placement) {
  const double scale = placement.scale();
  b.origin_m = placement.point(b.origin_m);
  for (Vec3* v : {&b.axis, &b.side, &b.up}) *v = placement.direction(*v);
  for (double* length :
       {&b.volume.outer_radius, &b.volume.hot_spot_length, &b.volume.lowest, &b.volume.highest})
    *length *= scale;
  return b;
}

}  // namespace

void add_boughs(const Target& to, const Prototype& prototype, PrototypeScene& out) {
  if (out.shoot_elements.empty()) return;
  for (const std::uint32_t i : out.shoot_elements)
    out.boughs.push_back(placed(
        shoot_bough(prototype.foliage[i], needles_of_element(to.options, prototype, i)), to.placement));
  attach_solids(to, out, kShoots, out.boughs.size(), {bough_bounds, bough_intersect, bough_occluded});
}

}  // namespace sunfleck::trace
