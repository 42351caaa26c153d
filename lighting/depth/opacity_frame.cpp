// Axes, bounds and texel grid of an opacity map; see opacity_frame.h.
#include "lighting/depth/opacity_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "sim/base/contract.h"

namespace sunfleck {
namespace {

constexpr double kTexelsPerLeafSide = 1.5;
constexpr double kMostSlices = kMostOpacitySlices;
constexpr int kMargin = kOpacityMargin;

void include_extent(Box& box, const Vec3& centre, const Vec3& half_extent) {
  box.include(centre - half_extent);
  box.include(centre + half_extent);
}

// Half extent along the axes; for a triangle of the box around all its corners.
Vec3 half_extent(const FoliageElement& e, const LightAxes& axes) {
  const Vec3 u = glm::abs(along(axes, Vec3(e.half_u_m))), v = glm::abs(along(axes, Vec3(e.half_v_m)));
  return e.shape == ElementShape::kShoot ? u + glm::length(Vec3(e.half_v_m)) : u + v;
}

void include_wood(Box& box, const Prototype& prototype, const LightAxes& axes) {
  for (const WoodSegment& w : prototype.wood) {
    include_extent(box, along(axes, Vec3(w.from_m)), Vec3(w.radius_from_m));
    include_extent(box, along(axes, Vec3(w.to_m)), Vec3(w.radius_to_m));
  }
  for (const WoodTriangle& t : prototype.wood_mesh)
    for (const Vec3f& corner : {t.a_m, t.b_m, t.c_m}) box.include(along(axes, Vec3(corner)));
}

// Least and largest coordinate of all elements along an axis, in lanes of their own.
Vec2 extent_along(const ElementRows& e, const Vec3& axis) {
  constexpr std::size_t kLanes = 16;
  const Vec3f a(axis);
  std::array<float, kLanes> lo, hi;
  lo.fill(std::numeric_limits<float>::infinity());
  hi.fill(-std::numeric_limits<float>::infinity());
  const auto include = [&](std::size_t i, std::size_t lane) {
    const float c = a.x * e.x_m[i] + a.y * e.y_m[i] + a.z * e.z_m[i];
    const float half = std::fabs(a.x * e.u_x[i] + a.y * e.u_y[i] + a.z * e.u_z[i]) +
                       std::fabs(a.x * e.v_x[i] + a.y * e.v_y[i] + a.z * e.v_z[i]) + e.radius_m[i];
    lo[lane] = c - half < lo[lane] ? c - half : lo[lane];
    hi[lane] = c + half > hi[lane] ? c + half : hi[lane];
  };
  std::size_t i = 0;
  for (; i + kLanes <= e.size(); i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) include(i + lane, lane);
  for (; i < e.size(); ++i) include(i, 0);
  return {*std::min_element(lo.begin(), lo.end()), *std::max_element(hi.begin(), hi.end())};
}

double silhouette_area_m2(const FoliageElement& e) {
  if (e.shape != ElementShape::kShoot) return e.area_m2;
  return 4.0 * glm::length(Vec3(e.half_u_m)) * glm::length(Vec3(e.half_v_m));
}

std::size_t count_of(double extent, double step, double most) {
  return static_cast<std::size_t>(std::clamp(std::ceil(extent / step), 1.0, most));
}

}  // namespace

LightAxes light_axes(const Vec3& to_light) {
  SUNFLECK_EXPECTS(is_finite(to_light) && std::abs(glm::dot(to_light, to_light) - 1.0) < 1e-6);
  const double horizontal = std::hypot(to_light.x, to_light.y);
  const Vec3 across =
      horizontal > 1e-9 ? Vec3(-to_light.y / horizontal, to_light.x / horizontal, 0.0) : Vec3(1.0, 0.0, 0.0);
  return {across, glm::cross(to_light, across), to_light};
}

Box projected_bounds(const Prototype& prototype, const LightAxes& axes) {
  Box box;
  for (const FoliageElement& e : prototype.foliage)
    include_extent(box, along(axes, Vec3(e.centre_m)), half_extent(e, axes));
  include_wood(box, prototype, axes);
  return box;
}

double typical_leaf_side_m(const Prototype& prototype) {
  double sum = 0.0, squares = 0.0;
  for (const FoliageElement& e : prototype.foliage) {
    const double area = silhouette_area_m2(e);
    sum += area;
    squares += area * area;
  }
  return sum > 0.0 ? std::sqrt(squares / sum) : 0.0;
}

namespace {

OpacityLayout layout_around(const LightAxes& axes, const Box& box, double leaf_side_m, int resolution) {
  SUNFLECK_EXPECTS(resolution > 0);
  OpacityLayout layout;
  layout.axes = axes;
  if (box.empty()) return layout;
  const Vec3 size = box.size();
  const double longest = std::max(size.x, size.y);
  layout.texel_m = std::max(longest / resolution, kTexelsPerLeafSide * leaf_side_m);
  if (!(layout.texel_m > 0.0)) layout.texel_m = 1.0;  // nothing but points
  // One texel of margin takes what bilinear shares spill over the edge; a second, empty one lets depths fall
  // to 0 without a step.
  layout.texels_across = 2 * kMargin + count_of(size.x, layout.texel_m, resolution + 1);
  layout.texels_upwards = 2 * kMargin + count_of(size.y, layout.texel_m, resolution + 1);
  layout.slices = count_of(size.z, layout.texel_m, kMostSlices);
  layout.slice_m = size.z > 0.0 ? size.z / static_cast<double>(layout.slices) : layout.texel_m;
  layout.corner = {box.lo.x - kMargin * layout.texel_m, box.lo.y - kMargin * layout.texel_m};
  layout.lit_side_m = size.z > 0.0 ? box.hi.z : box.hi.z + 0.5 * layout.slice_m;
  return layout;
}

}  // namespace

OpacityLayout opacity_layout(const Prototype& prototype, const Vec3& to_light, int resolution) {
  const LightAxes axes = light_axes(to_light);
  return layout_around(axes, projected_bounds(prototype, axes), typical_leaf_side_m(prototype), resolution);
}

OpacityLayout opacity_layout(const Prototype& prototype, const ElementRows& rows, const Vec3& to_light,
                             int resolution) {
  const LightAxes axes = light_axes(to_light);
  Box box;
  if (rows.size() > 0) {
    const Vec2 x = extent_along(rows, axes.across), y = extent_along(rows, axes.upwards),
               z = extent_along(rows, axes.to_light);
    box.include({x.x, y.x, z.x});
    box.include({x.y, y.y, z.y});
  }
  include_wood(box, prototype, axes);
  return layout_around(axes, box, rows.typical_side_m, resolution);
}

bool OpacityLayout::locate(const Vec3& point, OpacitySite& site) const {
  if (slices == 0) return false;
  const Vec3 p = along(axes, point);
  const double x = (p.x - corner.x) / texel_m - 0.5, y = (p.y - corner.y) / texel_m - 0.5;
  const double last_x = static_cast<double>(texels_across - 1),
               last_y = static_cast<double>(texels_upwards - 1);
  if (!(x >= 0.0 && y >= 0.0 && x < last_x && y < last_y)) return false;
  const std::size_t i = static_cast<std::size_t>(x), j = static_cast<std::size_t>(y);
  const double right = x - static_cast<double>(i), up = y - static_cast<double>(j);
  const std::size_t first = j * texels_across + i;
  site.column = {first, first + 1, first + texels_across, first + texels_across + 1};
  site.weight = {(1.0 - right) * (1.0 - up), right * (1.0 - up), (1.0 - right) * up, right * up};
  const double depth = std::clamp((lit_side_m - p.z) / slice_m, 0.0, static_cast<double>(slices));
  site.slice = std::min(static_cast<std::size_t>(depth), slices - 1);
  site.part = depth - static_cast<double>(site.slice);
  return true;
}

}  // namespace sunfleck
