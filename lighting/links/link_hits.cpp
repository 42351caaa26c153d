#include "lighting/links/link_hits.h"

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

}  // namespace sunfleck::links
