// Direct sun on one surface by shadow rays from points of it.
#pragma once

#include "lighting/sky/illumination.h"
#include "lighting/trace/ray_scene.h"
#include "lighting/trace/surface_sampler.h"

namespace sunfleck::trace {

// For a beam of 1 W m-2.
struct SunOnSurface {
  double front = 0, back = 0;  // irradiance
  double seen = 0;             // share of the rays that reach the sun
  double variance = 0;         // of front + back, unbiased; 0 for fewer than two rays or spread points
};

enum class SunPoints {
  kIndependent,  // random points: the spread of the rays tells the variance
  // A shifted lattice over the surface: less noise (variance about 2 / sqrt(rays) of that of as many random
  // points on a clumped crown), but of a size it does not know.
  kSpread
};

SunOnSurface sun_on_surface(const RayScene& scene, const SurfaceSampler& surface, const Illumination& light,
                            int rays, SunPoints points, RandomStream& random);

}  // namespace sunfleck::trace
