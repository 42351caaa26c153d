// Head comment in camera_message.h.
#include "server/convert/camera_message.h"

#include "sunfleck/v1/render.pb.h"

namespace sunfleck {
namespace {

CameraKind kind_from_message(v1::CameraKind kind, const std::string& field, Violations& violations) {
  switch (kind) {
    case v1::CAMERA_KIND_UNSPECIFIED:
    case v1::CAMERA_KIND_PINHOLE:
      return CameraKind::kPinhole;
    case v1::CAMERA_KIND_ORTHOGRAPHIC:
      return CameraKind::kOrthographic;
    case v1::CAMERA_KIND_FISHEYE:
      return CameraKind::kFisheye;
    default:
      break;
  }
  violations.add(field, "unknown camera kind " + std::to_string(kind));
  return CameraKind::kPinhole;
}

Vec3 point_from_message(const v1::Vector3& message, const std::string& field, Violations& violations) {
  constexpr double kFarthest_m = 1e7;
  violations.number(field + ".x", message.x(), -kFarthest_m, kFarthest_m);
  violations.number(field + ".y", message.y(), -kFarthest_m, kFarthest_m);
  violations.number(field + ".z", message.z(), -kFarthest_m, kFarthest_m);
  return {message.x(), message.y(), message.z()};
}

void fill_vector(const Vec3& from, v1::Vector3& to) {
  to.set_x(from.x);
  to.set_y(from.y);
  to.set_z(from.z);
}

// A camera needs a direction to look in and an up that is another one.
void check_directions(const Camera& camera, const std::string& field, Violations& violations) {
  const Vec3 view = camera.look_at_m - camera.position_m;
  if (glm::length(view) < 1e-9) {
    violations.add(field + ".look_at_m", "must differ from position_m");
  } else if (glm::length(camera.up) < 1e-9) {
    violations.add(field + ".up", "must not have length 0");
  }
}

void read_size(const v1::Camera& message, const std::string& field, const Limits& limits,
               Violations& violations, Camera& camera) {
  camera.width_px = message.width_px();
  camera.height_px = message.height_px();
  if (message.has_samples_per_pixel()) camera.samples_per_pixel = message.samples_per_pixel();
  const bool width = violations.integer(field + ".width_px", camera.width_px, 1, limits.image_side_px);
  const bool height = violations.integer(field + ".height_px", camera.height_px, 1, limits.image_side_px);
  const bool samples = violations.integer(field + ".samples_per_pixel", camera.samples_per_pixel, 1, 4096);
  if (!width || !height || !samples) return;
  const auto work = static_cast<std::uint64_t>(camera.width_px) *
                    static_cast<std::uint64_t>(camera.height_px) *
                    static_cast<std::uint64_t>(camera.samples_per_pixel);
  if (work > limits.image_samples) {
    violations.add(field + ".samples_per_pixel", "must keep pixels times samples within " +
                                                     std::to_string(limits.image_samples) + ", got " +
                                                     std::to_string(work));
  }
}

}  // namespace

Camera camera_from_message(const v1::Camera& message, const std::string& field, const Limits& limits,
                           Violations& violations) {
  Camera camera;
  camera.kind = kind_from_message(message.kind(), field + ".kind", violations);
  camera.position_m = point_from_message(message.position_m(), field + ".position_m", violations);
  camera.look_at_m = point_from_message(message.look_at_m(), field + ".look_at_m", violations);
  if (message.has_up()) camera.up = point_from_message(message.up(), field + ".up", violations);
  check_directions(camera, field, violations);
  if (message.has_vertical_fov_deg()) camera.vertical_fov_deg = message.vertical_fov_deg();
  if (message.has_ortho_height_m()) camera.ortho_height_m = message.ortho_height_m();
  violations.above(field + ".vertical_fov_deg", camera.vertical_fov_deg, 0, 170);
  violations.above(field + ".ortho_height_m", camera.ortho_height_m, 0, 1e6);
  if (message.has_seed()) camera.seed = message.seed();
  read_size(message, field, limits, violations, camera);
  return camera;
}

void fill_message(const Camera& camera, v1::Camera& message) {
  switch (camera.kind) {
    case CameraKind::kPinhole:
      message.set_kind(v1::CAMERA_KIND_PINHOLE);
      break;
    case CameraKind::kOrthographic:
      message.set_kind(v1::CAMERA_KIND_ORTHOGRAPHIC);
      break;
    case CameraKind::kFisheye:
      message.set_kind(v1::CAMERA_KIND_FISHEYE);
      break;
  }
  fill_vector(camera.position_m, *message.mutable_position_m());
  fill_vector(camera.look_at_m, *message.mutable_look_at_m());
  fill_vector(camera.up, *message.mutable_up());
  message.set_vertical_fov_deg(camera.vertical_fov_deg);
  message.set_ortho_height_m(camera.ortho_height_m);
  message.set_width_px(camera.width_px);
  message.set_height_px(camera.height_px);
  message.set_samples_per_pixel(camera.samples_per_pixel);
  message.set_seed(camera.seed);
}

}  // namespace sunfleck
