// The loop that all render modes share: rounds of passes over tiles until the samples asked for are taken or
// the noise is low enough. What a pixel draws depends on its number and the unit's alone, so pictures are the
// same for any number of threads, and a picture to a noise target is the one of that many samples.
#pragma once

#include <functional>

#include "lighting/render/film.h"
#include "lighting/render/render.h"

namespace sunfleck {

struct PassPlan {
  int samples_per_unit = 1;
  int units = 4;  // without noise target; else at most
  RenderEffort effort{};
};
// Units of `samples_per_unit` samples that hold at least the camera's samples (or, with a noise target, at
// most max_samples_per_pixel).
PassPlan plan_passes(const Camera& camera, const RenderEffort& effort, int samples_per_unit);

// Mean radiance of one unit of a pixel.
using UnitSampler = std::function<Vec3(int x_px, int y_px, std::size_t pixel, std::uint32_t unit)>;
// Fills the layers other than colour of one pixel.
using LayerFill = std::function<void(int x_px, int y_px, std::size_t pixel, Image& image)>;

// Adds units [first_unit, end_unit) of all pixels to the film. Calls `tile_done` for every finished 64 x 64
// tile of the round (or a larger rectangle made of them), from any thread.
struct PixelRect {
  int x0, y0, x1, y1;
};
// Of a picture, rows of tiles from the top.
std::vector<PixelRect> picture_tiles(int width_px, int height_px);
using TileDone = std::function<void(const PixelRect&)>;
using RoundSampler = std::function<void(std::uint32_t first_unit, std::uint32_t end_unit, Image& image,
                                        Film& film, const TileDone& tile_done)>;
Image run_rounds(const Camera& camera, const PassPlan& plan, const RoundSampler& sample,
                 const TileSink& tiles);

Image run_passes(const Camera& camera, const PassPlan& plan, const UnitSampler& sample,
                 const LayerFill& layers, const RunControl& control, const TileSink& tiles);

}  // namespace sunfleck
