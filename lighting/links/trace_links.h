// Traces the links of a forest. A prototype that stands more than once is traced alone first; rays that leave
// it go on through the forest from every instance. A ray that goes on passes its own tree, which it is known
// to have left: leaves it could meet again by rounding only, needles by a second lot. Where crowns interlock,
// links within a tree are cast again: a neighbour may stand in between.
#pragma once

#include "lighting/links/link_rays.h"
#include "lighting/links/link_table.h"
#include "lighting/trace/ray_scene.h"
#include "sim/base/run_control.h"

namespace sunfleck::links {

struct LinkScene {
  const Forest& forest;
  const trace::Receivers& receivers;
  const RayScene& rays;
};

// Throws Error(kLimitExceeded) naming "links.links_per_face" once it is known that the table will be larger
// than the limit: at once where the prototypes alone are, else before rays are cast between instances.
// Progress stage "tracing links".
LinkTable trace_links(const LinkScene& scene, int links_per_face, std::uint64_t seed,
                      std::uint64_t memory_limit_bytes, const RunControl& control);

}  // namespace sunfleck::links
