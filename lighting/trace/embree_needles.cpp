// Needles one by one as Embree's round linear curves: a cylinder with half balls as ends, together as long as
// the needle and, ends included, of the area of the needle's side. Their places are those of expand_needles
// in the prototype's coordinates; instances share them. (Embree 3.13's curves with flat ends,
// CONE_LINEAR_CURVE, are missed by rays into scaled instances.)
#include <embree3/rtcore.h>

#include <algorithm>

#include "lighting/trace/embree_scene.h"
#include "sim/base/error.h"

namespace sunfleck::trace {
namespace {

struct CurvePoint {
  float x, y, z, radius;
};

void count_needles(const Target& to, const Prototype& prototype, PrototypeScene& out) {
  constexpr std::size_t kMost = 0xFFFFFFFEu / 2;  // two points each, numbered in 32 bits
  std::size_t count = 0;
  for (const std::uint32_t i : out.shoot_elements) {
    count += needle_count(needles_of_element(to.options, prototype, i));
    if (count > kMost)
      throw Error(ErrorKind::kLimitExceeded, prototype.name, "has more needles than can be numbered",
                  "at most " + std::to_string(kMost) + ", or shoots drawn as volumes");
    out.needles_up_to.push_back(static_cast<std::uint32_t>(count));
  }
}

CurvePoint placed(const Placement& placement, const Vec3& at, double radius_m) {
  const Vec3 p = placement.point(at);
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z),
          static_cast<float>(placement.scale() * radius_m)};
}

void write_needles(const Target& to, const Prototype& prototype, const PrototypeScene& out,
                   CurvePoint* points) {
  std::vector<Needle> needles;
  for (const std::uint32_t i : out.shoot_elements) {
    needles.clear();
    expand_needles(prototype.foliage[i], needles_of_element(to.options, prototype, i), to.options.needle_seed,
                   i, needles);
    for (const Needle& n : needles) {
      const Vec3 base(n.base_m), tip(n.tip_m);
      const double length = glm::distance(base, tip), radius_m = n.radius_m;
      const double share = length > 0.0 ? std::min(0.5, radius_m / length) : 0.5;  // taken by each end
      *points++ = placed(to.placement, glm::mix(base, tip, share), radius_m);
      *points++ = placed(to.placement, glm::mix(tip, base, share), radius_m);
    }
  }
}

// A ray does not hit the needle it starts on, nor a tree it passes.
void skip_start(const RTCFilterFunctionNArguments* args) {
  const auto& context = *reinterpret_cast<const RayContext*>(args->context);
  const auto& prototype = *static_cast<const PrototypeScene*>(args->geometryUserPtr);
  const unsigned copy = copy_met(prototype, RTCHitN_instID(args->hit, args->N, 0, 0));
  if (is_passed(context, copy)) args->valid[0] = 0;
  if (context.from.needle == RayHit::kNoNeedle) return;
  const NeedlePlace place = needle_place(prototype, RTCHitN_primID(args->hit, args->N, 0));
  if (place.needle == context.from.needle &&
      is_start(context, copy, HitKind::kFoliage, prototype.shoot_elements[place.shoot]))
    args->valid[0] = 0;
}

}  // namespace

const FoliageTemplate& needles_of_element(const RayScene::Options& options, const Prototype& prototype,
                                          std::uint32_t element) {
  const std::string& material = prototype.materials[prototype.foliage[element].material];
  const NeedleKind* kind = find_needle_kind(options.needles, material);
  if (kind == nullptr)
    throw_invalid("needles", "nothing is known of the needles of '" + material + "'",
                  "a species with shoots, or shoots drawn as volumes");
  return kind->foliage;
}

NeedlePlace needle_place(const PrototypeScene& prototype, unsigned primitive) {
  const auto& up_to = prototype.needles_up_to;
  const auto at = std::upper_bound(up_to.begin(), up_to.end(), primitive);
  const auto shoot = static_cast<std::size_t>(at - up_to.begin());
  return {shoot, primitive - (shoot > 0 ? up_to[shoot - 1] : 0)};
}

void add_needles(const Target& to, const Prototype& prototype, PrototypeScene& out) {
  if (out.shoot_elements.empty()) return;
  count_needles(to, prototype, out);
  const std::size_t count = out.needles_up_to.back();
  const RTCGeometry geometry = rtcNewGeometry(to.device.get(), RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
  auto* points = static_cast<CurvePoint*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof(CurvePoint), 2 * count));
  auto* first = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, sizeof(unsigned), count));
  to.device.check("needle buffers");
  write_needles(to, prototype, out, points);
  for (std::size_t i = 0; i < count; ++i) first[i] = static_cast<unsigned>(2 * i);
  rtcSetGeometryUserData(geometry, &out);
  rtcSetGeometryIntersectFilterFunction(geometry, skip_start);
  rtcSetGeometryOccludedFilterFunction(geometry, skip_start);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(to.scene, geometry, to.first_id + kNeedles);
  rtcReleaseGeometry(geometry);
}

}  // namespace sunfleck::trace
