// Direct sun on every element, by whichever is cheaper at the error asked for: a picture of the sun
// (sun_raster.h), which must draw everything, or shadow rays, which are cast for the elements wanted alone.
#pragma once

#include <span>
#include <string>

#include "lighting/trace/probe_light.h"
#include "lighting/trace/sun_raster.h"

namespace sunfleck {

// Predictions of CPU seconds on a 2.6 GHz core, good to a factor of two; what planners compare.
struct RasterCost {
  double cpu_s = 0, pixel_m = 0;
  int sun_directions = 1;
};
RasterCost estimate_raster_cost(const Forest& forest, const ForestIndex& index, double half_angle_rad,
                                const SunRasterOptions& options);
// Of `rays` to each of `elements` elements; `scene_ready`: a ProbeScene is there already.
double estimate_shadow_ray_cost(const Forest& forest, const ForestIndex& index, std::size_t elements,
                                int rays, bool scene_ready);
// Spread shadow rays per element for that relative error (as SunRasterOptions::target_error) on a dense
// crown.
int shadow_rays_for(double target_error);

struct DirectExposure {
  SunExposure sun;  // of elements not wanted: drawn too, or 0 after rays
  bool by_raster = true;
  int rays = 0;        // per element, else
  std::string reason;  // the predicted costs, in words
};

// `wanted`: the elements asked for, in ForestIndex order; empty: all. `scene` may be null: built where rays
// are chosen. Rays are 8 independently shifted lattices per element, whose spread tells the standard error.
DirectExposure direct_sun_exposure(const Forest& forest, const ForestIndex& index, const ProbeScene* scene,
                                   const Illumination& light, std::span<const std::size_t> wanted,
                                   const SunRasterOptions& options, const RunControl& control);

}  // namespace sunfleck
