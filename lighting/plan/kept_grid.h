// The grid method with its preparation, its sun and its sky each kept in the scene's store.
#pragma once

#include "lighting/optics/optics.h"
#include "lighting/plan/light_scene.h"
#include "lighting/sky/illumination.h"
#include "lighting/transport/grid_estimator.h"

namespace sunfleck {

LightMap kept_grid_light_map(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
                             const GridOptions& options, const RunControl& control);

}  // namespace sunfleck
