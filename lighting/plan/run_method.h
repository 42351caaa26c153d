// Which estimator answers for which method, with which of the request's options: the only place that knows
// them all.
#pragma once

#include <span>

#include "lighting/plan/light_request.h"
#include "lighting/plan/light_scene.h"

namespace sunfleck {

// Runs the method that the request names, any but kAuto. `light` as returned by checked(), idle sources
// dropped. `sunlit_fraction`: of every element where it is known already, for grid and links; else empty.
LightMap run_method(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
                    const LightRequest& request, std::span<const float> sunlit_fraction,
                    const RunControl& control);

}  // namespace sunfleck
