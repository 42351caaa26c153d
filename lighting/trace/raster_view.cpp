#include "lighting/trace/raster_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sunfleck::trace {
namespace {

// Gradient of the height above the ground plane.
Vec3 height_gradient(const Terrain& terrain) {
  const Vec3 n = terrain.normal();
  return {n.x / n.z, n.y / n.z, 1.0};
}

double height_above(const Terrain& terrain, const Vec3& p) { return p.z - terrain.height_at(p.x, p.y); }

void take_plane_across(RasterView& view, double pixel_m, double turn) {
  const Basis basis = basis_around(view.to_sun);
  const Vec3 u = std::cos(turn) * basis.tangent + std::sin(turn) * basis.bitangent;
  const Vec3 v = glm::cross(view.to_sun, u);
  view.u_per_m = u / pixel_m;
  view.v_per_m = v / pixel_m;
  view.s_per_m = view.to_sun;
  view.u_step_m = pixel_m * u;
  view.v_step_m = pixel_m * v;
  view.pixel_area_m2 = pixel_m * pixel_m;
}

// Length across the beam of a step along the ground.
double length_across(const Vec3& step, const Vec3& to_sun) {
  return glm::length(step - glm::dot(step, to_sun) * to_sun);
}

std::int32_t pixels_along(double length_m, double pixel_m) {
  constexpr double kFewest = 16, kMost = 1 << 30;
  return static_cast<std::int32_t>(std::clamp(std::ceil(length_m / pixel_m), kFewest, kMost));
}

void take_ground_plane(RasterView& view, const Forest& forest, double pixel_m) {
  const Vec3 rise = height_gradient(forest.terrain);
  const double climb = glm::dot(rise, view.to_sun);
  const Vec3 east(1, 0, -rise.x), north(0, 1, -rise.y);  // along the ground, 1 m aside
  const double across_x = length_across(east, view.to_sun), across_y = length_across(north, view.to_sun);
  // Pixels of the wanted area across the beam, as square there as the period's axes allow.
  const double stretch = std::sqrt(across_x * across_y / std::abs(climb));
  view.wraps = true;
  const Vec2 size = forest.period->size_m;
  view.u_count = pixels_along(size.x, std::max(pixel_m * stretch / across_x, 1e-9));
  view.v_count = pixels_along(size.y, std::max(pixel_m * stretch / across_y, 1e-9));
  const double step_x = size.x / view.u_count, step_y = size.y / view.v_count;
  view.s_per_m = rise / climb;
  view.u_per_m = (Vec3(1, 0, 0) - view.to_sun.x * view.s_per_m) / step_x;
  view.v_per_m = (Vec3(0, 1, 0) - view.to_sun.y * view.s_per_m) / step_y;
  view.u_step_m = step_x * east;
  view.v_step_m = step_y * north;
  view.pixel_area_m2 = std::abs(glm::dot(glm::cross(view.u_step_m, view.v_step_m), view.to_sun));
}

void take_ground(RasterView& view, const Terrain& terrain, double rounding_m) {
  const Vec3 rise = height_gradient(terrain);
  const double climb = glm::dot(rise, view.to_sun);
  // What lies on the ground is above it.
  const double height = height_above(terrain, view.centre_m) + rounding_m;
  const double at_u = glm::dot(rise, view.u_step_m), at_v = glm::dot(rise, view.v_step_m);
  view.ground_s_per_u = -at_u / climb;
  view.ground_s_per_v = -at_v / climb;
  view.ground_s = -height / climb - view.u_shift * view.ground_s_per_u - view.v_shift * view.ground_s_per_v;
}

}  // namespace

double climb_of(const Terrain& terrain, const Vec3& direction) {
  return glm::dot(height_gradient(terrain), direction);
}

RasterView make_view(const Forest& forest, const Box& bounds, const Vec3& to_sun, double pixel_m, bool ground,
                     RandomStream random) {
  RasterView view;
  view.centre_m = bounds.centre();
  view.to_sun = to_sun;
  const double turn = 2.0 * kPi * random.uniform();
  if (forest.period)
    take_ground_plane(view, forest, pixel_m);
  else
    take_plane_across(view, pixel_m, turn);
  view.u_shift = random.uniform();
  view.v_shift = random.uniform();
  if (!view.wraps) {  // everything at positive coordinates
    view.u_shift += std::ceil(0.5 * glm::dot(glm::abs(view.u_per_m), bounds.size())) + 1.0;
    view.v_shift += std::ceil(0.5 * glm::dot(glm::abs(view.v_per_m), bounds.size())) + 1.0;
  }
  if (ground)
    take_ground(view, forest.terrain, 4e-6 * glm::length(bounds.size()));
  else
    view.ground_s = -std::numeric_limits<double>::infinity();
  return view;
}

}  // namespace sunfleck::trace
