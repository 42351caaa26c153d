// The surfaces of a tree with their rays, one after the other.
#pragma once

#include <functional>

#include "lighting/links/link_rays.h"
#include "lighting/links/link_table.h"
#include "sim/base/run_control.h"

namespace sunfleck::links {

// Calls visit(surface, rays) for every surface of the tree, neighbours in space one after the other, from
// many threads.
using SurfaceVisit = std::function<void(std::size_t surface, const SurfaceRays& rays)>;
void for_each_surface(const LoneTree& tree, int links_per_face, std::uint64_t seed, const RunControl& control,
                      const SurfaceVisit& visit);

// Rows without links, room for the counts of all lobes.
TreeLinks empty_links(const LoneTree& tree, int links_per_face);
// Counts and weights of the lobes of a surface.
void set_lobes(TreeLinks& tree, std::size_t surface, const SurfaceRays& rays);

}  // namespace sunfleck::links
