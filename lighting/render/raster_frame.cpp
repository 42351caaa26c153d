#include "lighting/render/raster_frame.h"

#include <cmath>

#include "lighting/render/camera_rays.h"
#include "sim/base/contract.h"

namespace sunfleck {

RasterFrame camera_frame(const Camera& camera) {
  SUNFLECK_EXPECTS(camera.kind != CameraKind::kFisheye);
  const CameraRays rays(camera);
  RasterFrame f;
  f.perspective = camera.kind == CameraKind::kPinhole;
  f.origin_m = camera.position_m;
  f.forward = rays.forward();
  f.right = rays.right();
  f.down = -rays.up();
  f.centre_px = {0.5 * camera.width_px, 0.5 * camera.height_px};
  if (f.perspective) {
    f.px_per_unit = 0.5 * camera.height_px / std::tan(0.5 * radians_from_degrees(camera.vertical_fov_deg));
  } else {
    f.px_per_unit = camera.height_px / camera.ortho_height_m;
    f.farthest = -std::numeric_limits<double>::infinity();
    f.nearest = 0.0;
  }
  return f;
}

RasterFrame sun_frame(const Vec3& to_sun, const Vec3& middle_m, const Vec2& middle_px, double px_per_m) {
  const Basis around = basis_around(-to_sun);
  RasterFrame f;
  f.perspective = false;
  f.origin_m = middle_m;
  f.forward = -to_sun;
  f.right = around.tangent;
  f.down = around.bitangent;
  f.px_per_unit = px_per_m;
  f.centre_px = middle_px;
  f.farthest = -std::numeric_limits<double>::infinity();
  return f;
}

}  // namespace sunfleck
