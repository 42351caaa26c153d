// Direct sun by shadow rays in place of a smooth method's: a leaf is in the sun or not, which no mean over a
// cell can tell.
#pragma once

#include <cstdint>

#include "lighting/base/light_map.h"
#include "lighting/trace/probe_light.h"

namespace sunfleck {

// `rays` to every foliage element, from points spread evenly over it. Replaces the direct light and the
// sunlit fraction; everything else stays, sums are not updated. Progress stage "tracing sun".
void trace_direct(const ProbeScene& scene, const Illumination& light, int rays, std::uint64_t seed,
                  LightMap& map, const RunControl& control);

}  // namespace sunfleck
