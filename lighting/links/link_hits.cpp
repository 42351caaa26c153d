#include "lighting/links/link_hits.h"

#include <cmath>

#include "lighting/links/link_ends.h"

namespace sunfleck::links {

std::uint32_t end_of(const trace::Receivers& receivers, const RayHit& hit, const Vec3& direction) {
  return hit.kind == HitKind::kSky ? sky_end(direction) : receivers.met_by(hit);
}

bool is_on_tree(const RayHit& hit) { return hit.kind != HitKind::kSky && hit.kind != HitKind::kGround; }

std::uint32_t own_face(const LoneTree& tree, RayHit hit) {
  hit.instance = 0;
  return tree.receivers().met_by(hit);
}

namespace {

// True if the hit lies on the instance itself, not on a copy of it in another period.
bool is_own(const LinkScene& scene, const RayHit& hit, const LinkRay& ray, std::uint32_t instance) {
  if (!is_on_tree(hit) || hit.instance != instance) return false;
  if (!scene.forest.period) return true;
  const Vec3 away = hit.on_original_m - (ray.origin_m + hit.distance_m * ray.direction);
  const Vec2 size = scene.forest.period->size_m;
  return std::abs(away.x) < 0.5 * size.x && std::abs(away.y) < 0.5 * size.y;
}

}  // namespace

RayHit beyond_own_tree(const LinkScene& scene, const LinkRay& ray, std::uint32_t instance) {
  constexpr int kMostHits = 1000;
  double from_m = 0.0;
  for (int i = 0;; ++i) {
    const RayHit hit = scene.rays.closest_hit(ray.origin_m, ray.direction, from_m, ray.from);
    if (i == kMostHits || !is_own(scene, hit, ray, instance)) return hit;
    from_m = hit.distance_m * (1.0 + 1e-6) + 1e-9;
  }
}

}  // namespace sunfleck::links
