// A picture from a light map without rays from the camera and to the sun: what samples see and which of them
// the sun sees come from rasterising. Samples lie where rays would be sent; each figure seen in a pixel is
// shaded once for all samples that show it, sunlight alone is asked per sample. Ground and wood get their sky
// and scattered light from kept nodes (raster_gather.h), which is where the few rays that remain are cast.
#pragma once

#include <optional>

#include "lighting/render/raster_sun.h"
#include "lighting/render/render_passes.h"
#include "lighting/render/shader.h"

namespace sunfleck {

// What is drawn, prepared once per picture.
struct RasterScene {
  FigureTable figures;
  RasterFrame frame;
  SeenTrees trees;
  SunTrees sun_trees;
};
// Why a picture cannot be rasterised: a camera without a plane picture, a view of a periodic forest that has
// no end, too much to number. Empty: it can.
struct RasterRefusal {
  std::string where, problem, remedy;
};
struct RasterAttempt {
  std::unique_ptr<RasterScene> scene;
  RasterRefusal refusal;  // where there is no scene
};
RasterAttempt prepare_raster(const PictureScene& scene, const Camera& camera, const Vec3& to_sun);

// Writes the layers other than colour for what a pixel's centre shows.
using HitLayers = std::function<void(const RayHit& hit, std::size_t pixel, Image& image)>;

// `light`: of the sun's disc. Same samples, units and layers as run_passes with rays.
Image rasterise(const RasterScene& raster, const ShadingParts& parts, const Shader& shader,
                const Camera& camera, const Illumination& light, const PassPlan& plan,
                const HitLayers& layers, const RunControl& control, const TileSink& tiles);

}  // namespace sunfleck
