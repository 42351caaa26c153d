// What a ray of a link met, as a face or an end.
#pragma once

#include "lighting/links/link_rays.h"
#include "lighting/links/trace_links.h"

namespace sunfleck::links {

bool is_on_tree(const RayHit& hit);
// Face or end among all of the forest.
std::uint32_t end_of(const trace::Receivers& receivers, const RayHit& hit, const Vec3& direction);
// The face of its own tree that a hit lies on, as the tree alone numbers them.
std::uint32_t own_face(const LoneTree& tree, RayHit hit);

}  // namespace sunfleck::links
