// Direct sun on every face, as an input of the links method: whoever knows it better (an item buffer seen
// from the sun, more rays) may fill it in. Here: shadow rays from points spread evenly over each surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lighting/sky/illumination.h"
#include "lighting/trace/ray_scene.h"
#include "lighting/trace/receivers.h"
#include "sim/base/run_control.h"

namespace sunfleck::links {

struct DirectLight {
  std::vector<float> on_face;          // irradiance for a beam of 1 W m-2, per face of trace::Receivers
  std::vector<float> sunlit_fraction;  // per foliage element
};

// `light` as returned by checked(); no sun above the horizon: all 0, no rays. Progress stage "tracing sun".
DirectLight direct_light_by_rays(const trace::Receivers& receivers, const RayScene& scene,
                                 const Illumination& light, int rays_per_surface, std::uint64_t seed,
                                 const RunControl& control);

// Of foliage by the share of each element that is in the sun (of the same sun, as raster_sun() draws it), of
// wood and ground by shadow rays.
DirectLight direct_light_by_shares(const trace::Receivers& receivers, const RayScene& scene,
                                   const Illumination& light, std::span<const float> sunlit_fraction,
                                   int rays_per_surface, std::uint64_t seed, const RunControl& control);

}  // namespace sunfleck::links
