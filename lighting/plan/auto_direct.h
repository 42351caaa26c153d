// Direct sun as the sun sees it (lighting/trace/sun_raster.h) in place of a smooth method's: a leaf is in the
// sun or not, which no mean over a cell can tell.
#pragma once

#include <memory>

#include "lighting/base/light_map.h"
#include "lighting/plan/light_scene.h"
#include "lighting/sky/illumination.h"
#include "lighting/trace/sun_raster.h"

namespace sunfleck {

// Kept in the scene's store by sun and options.
std::shared_ptr<const SunExposure> sun_exposure(const LightScene& scene, const Illumination& light,
                                                const SunRasterOptions& options, const RunControl& control);

}  // namespace sunfleck
