#include "lighting/render/raster_choice.h"

#include "sim/base/error.h"

namespace sunfleck {

std::unique_ptr<RasterScene> chosen_raster(const PictureScene& scene, const RenderRequest& request,
                                           const Illumination& light) {
  if (request.visibility == Visibility::kRays) return nullptr;
  if (request.leaf_sun == LeafSun::kTile) {
    if (request.visibility == Visibility::kAuto) return nullptr;
    throw_invalid("render.leaf_sun", "is \"tile\", which is not rasterised",
                  "render.leaf_sun = \"traced\" or \"stored\", or render.visibility = \"rays\"");
  }
  if (request.look.shoots != ShootForm::kVolume) {
    if (request.visibility == Visibility::kAuto) return nullptr;
    throw_invalid("render.needles", "is not \"volume\", the one form of shoots that is rasterised",
                  "render.needles = \"volume\" or render.visibility = \"rays\"");
  }
  RasterAttempt attempt = prepare_raster(scene, request.camera, light.to_sun);
  if (attempt.scene == nullptr && request.visibility == Visibility::kRaster)
    throw_invalid(attempt.refusal.where, attempt.refusal.problem,
                  attempt.refusal.remedy + "; or render.visibility = \"rays\"");
  return std::move(attempt.scene);
}

}  // namespace sunfleck
