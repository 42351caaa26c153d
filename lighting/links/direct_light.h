// Direct sun on every face, as an input of the links method: whoever knows it better (an item buffer seen
// from the sun, more rays) may fill it in. Here: shadow rays from points spread evenly over each surface.
#pragma once

#include <cstdint>
#include <vector>

#include "lighting/sky/illumination.h"
#include "lighting/trace/ray_scene.h"
#include "lighting/trace/receivers.h"
#include "lighting/trace/sun_raster.h"
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

// Of foliage as the sun's picture shows it (raster_sun of the same sun), of wood and ground by shadow rays.
DirectLight direct_light_by_picture(const trace::Receivers& receivers, const RayScene& scene,
                                    const Illumination& light, const SunExposure& picture,
                                    int rays_per_surface, std::uint64_t seed, const RunControl& control);

}  // namespace sunfleck::links
