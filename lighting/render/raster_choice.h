// Rays or raster: what costs less for a picture from a light map.
#pragma once

#include "lighting/render/raster_image.h"

namespace sunfleck {

// The scene to rasterise, or nothing where rays are asked for or cost less. Throws Error(kInvalidInput /
// kLimitExceeded) where rasterising was asked for and cannot be done.
std::unique_ptr<RasterScene> chosen_raster(const PictureScene& scene, const RenderRequest& request,
                                           const Illumination& light);

}  // namespace sunfleck
