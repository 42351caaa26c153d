#include "lighting/render/camera_config.h"

#include <algorithm>
#include <cmath>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

Vec3 read_vector(const ConfigTable& table, const char* key) {
  const std::vector<double> v = table.numbers(key);
  if (v.size() != 3)
    throw_invalid(table.where(key), "has " + std::to_string(v.size()) + " numbers", "three: x, y, z");
  return {v[0], v[1], v[2]};
}

CameraKind read_kind(const ConfigTable& table) {
  const std::string kind = table.choice_or("kind", "pinhole", {"pinhole", "orthographic", "fisheye"});
  if (kind == "pinhole") return CameraKind::kPinhole;
  return kind == "fisheye" ? CameraKind::kFisheye : CameraKind::kOrthographic;
}

}  // namespace

Camera read_camera(const ConfigTable& table) {
  Camera c;
  c.kind = read_kind(table);
  c.position_m = read_vector(table, "position_m");
  c.look_at_m = read_vector(table, "look_at_m");
  if (table.has("up")) c.up = read_vector(table, "up");
  c.vertical_fov_deg = table.number_or("vertical_fov_deg", c.vertical_fov_deg, {0.01, 170});
  c.ortho_height_m = table.number_or("ortho_height_m", c.ortho_height_m, {1e-6, 1e6});
  c.width_px = static_cast<int>(table.integer_or("width_px", c.width_px, {1, 16384}));
  c.height_px = static_cast<int>(table.integer_or("height_px", c.height_px, {1, 16384}));
  c.samples_per_pixel =
      static_cast<int>(table.integer_or("samples_per_pixel", c.samples_per_pixel, {1, 4096}));
  c.seed = static_cast<std::uint64_t>(table.integer_or("seed", 1, {0, 9e15}));
  return c;
}

Camera default_camera(const Box& box) {
  const Vec3 size = box.size(), centre = box.empty() ? Vec3(0) : box.centre();
  const double reach = std::max({size.x, size.y, size.z, 1e-3});
  Camera c;
  c.look_at_m = centre;
  c.position_m = centre + Vec3(0.25 * reach, -1.4 * reach, 0.55 * reach);
  return c;
}

}  // namespace sunfleck
