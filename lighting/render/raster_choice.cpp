#include "lighting/render/raster_choice.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

// Measured: README, "Pictures".
constexpr double kPerPrototypeFigure_s = 5e-7, kPerCameraFigure_s = 2.2e-7, kPerSunFigure_s = 0.8e-7;
constexpr double kPerRasterSample_s = 3e-7, kPerRaySample_s = 2.5e-6;
constexpr double kPerNode_s = 25e-6, kMostNodes = 25'000;
constexpr double kSamplesPerChunk = 32, kSamplesPerBatch = 8 << 20;

RasterWork work_of(const RasterScene& raster, const RenderRequest& request, const Illumination& light) {
  const bool to_noise = request.effort.noise > 0.0;
  RasterWork work;
  work.prototype_figures = raster.figures.figures();
  work.camera_figures = raster.trees.figures;
  work.sun_figures = raster.sun_trees.figures();
  work.pixels = static_cast<std::uint64_t>(request.camera.width_px) *
                static_cast<std::uint64_t>(request.camera.height_px);
  // How many samples a noise takes is known afterwards; a few dozen is common.
  work.samples_per_pixel =
      to_noise ? static_cast<std::uint64_t>(std::min(32, request.effort.max_samples_per_pixel))
               : static_cast<std::uint64_t>(request.camera.samples_per_pixel);
  if (!light.sun_is_up()) work.sun_directions = 0;
  return work;
}

// What rays show and rasterising does not.
std::optional<RasterRefusal> refused_look(const RenderRequest& request) {
  if (request.leaf_sun == LeafSun::kTile)
    return RasterRefusal{"render.leaf_sun", "is \"tile\", which is not rasterised",
                         "\"traced\" or \"stored\", or render.visibility = \"rays\""};
  if (request.look.shoots != ShootForm::kVolume)
    return RasterRefusal{"render.needles", "is not \"volume\", the one form of shoots that is rasterised",
                         "\"volume\", or render.visibility = \"rays\""};
  return std::nullopt;
}

}  // namespace

double raster_cost_s(const RasterWork& w) {
  const auto pixels = static_cast<double>(w.pixels),
             samples = pixels * static_cast<double>(w.samples_per_pixel);
  const double chunks = std::ceil(static_cast<double>(w.samples_per_pixel) / kSamplesPerChunk);
  const double batches = std::ceil(samples / chunks / kSamplesPerBatch) * chunks;
  return kPerPrototypeFigure_s * static_cast<double>(w.prototype_figures) +
         chunks * kPerCameraFigure_s * static_cast<double>(w.camera_figures) +
         batches * w.sun_directions * kPerSunFigure_s * static_cast<double>(w.sun_figures) +
         kPerRasterSample_s * samples + kPerNode_s * std::min(pixels, kMostNodes);
}

double rays_cost_s(const RasterWork& w) {
  return kPerRaySample_s * static_cast<double>(w.pixels) * static_cast<double>(w.samples_per_pixel);
}

std::unique_ptr<RasterScene> chosen_raster(const PictureScene& scene, const RenderRequest& request,
                                           const Illumination& light) {
  if (request.visibility == Visibility::kRays) return nullptr;
  const bool by_cost = request.visibility == Visibility::kAuto;
  if (const auto refusal = refused_look(request)) {
    if (by_cost) return nullptr;
    throw_invalid(refusal->where, refusal->problem, refusal->remedy);
  }
  // Too few samples to pay for anything.
  RasterWork least;
  least.pixels = static_cast<std::uint64_t>(request.camera.width_px) *
                 static_cast<std::uint64_t>(request.camera.height_px);
  least.samples_per_pixel =
      static_cast<std::uint64_t>(request.effort.noise > 0.0 ? 32 : request.camera.samples_per_pixel);
  if (by_cost && raster_cost_s(least) > rays_cost_s(least)) return nullptr;
  RasterAttempt attempt = prepare_raster(scene, request.camera, light.to_sun);
  if (attempt.scene == nullptr && !by_cost)
    throw_invalid(attempt.refusal.where, attempt.refusal.problem,
                  attempt.refusal.remedy + "; or render.visibility = \"rays\"");
  if (attempt.scene != nullptr && by_cost) {
    const RasterWork work = work_of(*attempt.scene, request, light);
    if (raster_cost_s(work) > rays_cost_s(work)) return nullptr;
  }
  return std::move(attempt.scene);
}

}  // namespace sunfleck
