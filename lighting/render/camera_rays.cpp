// Camera frame: forward towards look_at, right = forward x up, picture up = right x forward. A picture that
// looks straight up with north as its top therefore has east on its left, as hemispherical photographs do.
#include "lighting/render/camera_rays.h"

#include <cmath>
#include <cstdint>
#include <string>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

constexpr int kMaxSidePx = 16384;
constexpr int kMaxSamples = 4096;
constexpr std::int64_t kMaxPixels = 100'000'000;  // 4 GB of layers
constexpr double kParallelSine = 1e-6;  // below it the direction of `up` in the picture is rounding noise

[[noreturn]] void refuse(const char* field, const std::string& problem, const std::string& remedy) {
  throw_invalid(std::string("camera.") + field, problem, remedy);
}

void check_point(const char* field, const Vec3& point) {
  if (!is_finite(point)) refuse(field, "is not finite", "give three finite numbers");
}

void check_range(const char* field, double value, double lo, double hi, const std::string& remedy) {
  if (!(value >= lo && value <= hi)) refuse(field, "is " + std::to_string(value), remedy);
}

void check_view(const Camera& camera) {
  check_point("position_m", camera.position_m);
  check_point("look_at_m", camera.look_at_m);
  check_point("up", camera.up);
  const double distance_m = glm::length(camera.look_at_m - camera.position_m);
  if (!(distance_m > 0.0) || !std::isfinite(distance_m))
    refuse("look_at_m", "gives no direction of view from position_m", "look at another point");
  const double length = glm::length(camera.up);
  if (!(length > 0.0) || !std::isfinite(length))
    refuse("up", "gives no direction", "give a vector such as (0, 0, 1)");
}

void check_projection(const Camera& camera) {
  if (camera.kind == CameraKind::kPinhole && camera.vertical_fov_deg <= 0.0)
    refuse("vertical_fov_deg", "is " + std::to_string(camera.vertical_fov_deg), "use degrees in (0, 170]");
  if (camera.kind == CameraKind::kPinhole)
    check_range("vertical_fov_deg", camera.vertical_fov_deg, 0.0, 170.0, "use degrees in (0, 170]");
  if (camera.kind == CameraKind::kOrthographic &&
      !(camera.ortho_height_m > 0.0 && std::isfinite(camera.ortho_height_m)))
    refuse("ortho_height_m", "is " + std::to_string(camera.ortho_height_m), "use metres above 0");
}

// The wished up direction unless it lies along the view.
Vec3 usable_up(const Vec3& forward, const Vec3& wished) {
  for (const Vec3& up : {glm::normalize(wished), Vec3(0, 1, 0)})
    if (glm::length(glm::cross(forward, up)) > kParallelSine) return up;
  return Vec3(1, 0, 0);
}

}  // namespace

void validate(const Camera& camera) {
  check_view(camera);
  check_projection(camera);
  check_range("width_px", camera.width_px, 1, kMaxSidePx, "use 1 to 16384 pixels");
  check_range("height_px", camera.height_px, 1, kMaxSidePx, "use 1 to 16384 pixels");
  const std::int64_t pixels = std::int64_t{camera.width_px} * camera.height_px;
  if (pixels > kMaxPixels)
    throw Error(ErrorKind::kLimitExceeded, "camera.width_px",
                "times height_px is " + std::to_string(pixels) + " pixels", "at most 100 million together");
  check_range("samples_per_pixel", camera.samples_per_pixel, 1, kMaxSamples, "use 1 to 4096");
}

CameraRays::CameraRays(const Camera& camera) : camera_(camera) {
  forward_ = glm::normalize(camera.look_at_m - camera.position_m);
  right_ = glm::normalize(glm::cross(forward_, usable_up(forward_, camera.up)));
  up_ = glm::cross(right_, forward_);
}

std::optional<CameraRay> CameraRays::through(double x_px, double y_px) const {
  const double right_px = x_px - 0.5 * camera_.width_px;
  const double up_px = 0.5 * camera_.height_px - y_px;
  switch (camera_.kind) {
    case CameraKind::kPinhole:
      return pinhole(right_px, up_px);
    case CameraKind::kOrthographic:
      return orthographic(right_px, up_px);
    case CameraKind::kFisheye:
      break;
  }
  return fisheye(right_px, up_px);
}

CameraRay CameraRays::pinhole(double right_px, double up_px) const {
  const double half_height = std::tan(0.5 * radians_from_degrees(camera_.vertical_fov_deg));
  const double per_px = half_height / (0.5 * camera_.height_px);
  return {camera_.position_m,
          glm::normalize(forward_ + (right_px * per_px) * right_ + (up_px * per_px) * up_)};
}

CameraRay CameraRays::orthographic(double right_px, double up_px) const {
  const double m_per_px = camera_.ortho_height_m / camera_.height_px;
  return {camera_.position_m + (right_px * m_per_px) * right_ + (up_px * m_per_px) * up_, forward_};
}

// Equidistant: the angle from the axis grows in proportion to the distance from the centre.
std::optional<CameraRay> CameraRays::fisheye(double right_px, double up_px) const {
  const double circle_px = 0.5 * std::min(camera_.width_px, camera_.height_px);
  const double radius_px = std::hypot(right_px, up_px);
  if (radius_px > circle_px) return std::nullopt;
  if (radius_px == 0.0) return CameraRay{camera_.position_m, forward_};
  const double angle_rad = 0.5 * kPi * radius_px / circle_px;
  const Vec3 sideways = (right_px * right_ + up_px * up_) / radius_px;
  return CameraRay{camera_.position_m, std::cos(angle_rad) * forward_ + std::sin(angle_rad) * sideways};
}

}  // namespace sunfleck
