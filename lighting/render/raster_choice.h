// Rays or raster: what costs less for a picture from a light map. Raster pays per figure in view of camera
// and sun and little per sample, rays pay per sample.
#pragma once

#include "lighting/render/raster_image.h"

namespace sunfleck {

// What a picture asks for.
struct RasterWork {
  std::uint64_t prototype_figures = 0;                // made ready once
  std::uint64_t camera_figures = 0, sun_figures = 0;  // of all trees in view
  std::uint64_t pixels = 0, samples_per_pixel = 1;
  std::uint32_t sun_directions = 4;  // per chunk of samples; 0: no sun
};
// Seconds on one core of the machine it was measured on (AMD EPYC, forest_day.toml); only the ratio matters.
double raster_cost_s(const RasterWork& work);
double rays_cost_s(const RasterWork& work);

// The scene to rasterise, or nothing where rays are asked for or cost less. Throws Error(kInvalidInput /
// kLimitExceeded) where rasterising was asked for and cannot be done.
std::unique_ptr<RasterScene> chosen_raster(const PictureScene& scene, const RenderRequest& request,
                                           const Illumination& light);

}  // namespace sunfleck
