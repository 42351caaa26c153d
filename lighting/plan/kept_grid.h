// The grid method with its preparation, its sun and its sky each kept in the scene's store. The sun is not
// kept where the elements' share of it is given (`sunlit_fraction`, empty: not).
#pragma once

#include <span>

#include "lighting/optics/optics.h"
#include "lighting/plan/light_scene.h"
#include "lighting/sky/illumination.h"
#include "lighting/transport/grid_estimator.h"

namespace sunfleck {

LightMap kept_grid_light_map(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
                             const GridOptions& options, std::span<const float> sunlit_fraction,
                             const RunControl& control);

}  // namespace sunfleck
