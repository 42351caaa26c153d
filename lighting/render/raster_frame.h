// The picture plane of a rasteriser: a pinhole camera, an orthographic one, or the sun's view of the forest.
// Coordinates of the frame are metres to the right, downwards and ahead of its origin; a point (x, y, z) of
// it falls on the place
//   (centre_px + px_per_unit x / z, centre_px + px_per_unit y / z)   perspective (x / z is a tangent),
//   (centre_px + px_per_unit x, centre_px + px_per_unit y)           orthographic.
// Nearness orders what is seen through one place: 1 / z in perspective and -z else, both linear over the
// picture for a plane figure. Larger is nearer.
#pragma once

#include <algorithm>
#include <limits>

#include "lighting/render/render.h"

namespace sunfleck {

struct RasterFrame {
  bool perspective = true;
  Vec3 origin_m{0}, right{1, 0, 0}, down{0, 1, 0}, forward{0, 0, 1};
  double px_per_unit = 1;
  Vec2 centre_px{0};
  double farthest = 0;  // nearness of what is endlessly far: nothing farther is seen
  double nearest = std::numeric_limits<double>::infinity();  // nothing nearer

  Vec3 from_world(const Vec3& p) const { return turned(p - origin_m); }
  Vec3 turned(const Vec3& d) const { return {glm::dot(d, right), glm::dot(d, down), glm::dot(d, forward)}; }
  Vec3 world_direction(const Vec3& d) const { return d.x * right + d.y * down + d.z * forward; }
  // Of a place seen with a nearness, in the frame's coordinates.
  Vec3 point(const Vec2& place_px, double nearness) const {
    const Vec2 aside = (place_px - centre_px) / px_per_unit;
    if (!perspective) return {aside.x, aside.y, -nearness};
    return {aside.x / nearness, aside.y / nearness, 1.0 / nearness};
  }
  // The same with (0, 0) at another place.
  RasterFrame moved(const Vec2& corner_px) const {
    RasterFrame f = *this;
    f.centre_px -= corner_px;
    return f;
  }
};

// Of a pinhole or orthographic camera, the same places and rays as CameraRays.
RasterFrame camera_frame(const Camera& camera);
// Looks along the sun's rays: `middle_m` falls on `middle_px`.
RasterFrame sun_frame(const Vec3& to_sun, const Vec3& middle_m, const Vec2& middle_px, double px_per_m);

// What part of the picture a box in the frame's coordinates may touch, and its greatest nearness.
struct PictureExtent {
  double x_lo = 0, y_lo = 0, x_hi = 0, y_hi = 0, nearness = 0;
  bool seen = false;
};
inline PictureExtent extent_of(const RasterFrame& f, const Vec3& lo, const Vec3& hi) {
  constexpr double kAll = 1e9;
  if (!f.perspective) {
    return {f.centre_px.x + f.px_per_unit * lo.x,
            f.centre_px.y + f.px_per_unit * lo.y,
            f.centre_px.x + f.px_per_unit * hi.x,
            f.centre_px.y + f.px_per_unit * hi.y,
            -lo.z,
            -hi.z <= f.nearest};
  }
  if (!(hi.z > 0.0)) return {};
  // What reaches through the plane of the camera may be seen anywhere.
  if (!(lo.z > 1e-3 * hi.z)) return {-kAll, -kAll, kAll, kAll, std::numeric_limits<double>::infinity(), true};
  const double near = f.px_per_unit / lo.z, far = f.px_per_unit / hi.z;
  return {f.centre_px.x + lo.x * (lo.x < 0.0 ? near : far),
          f.centre_px.y + lo.y * (lo.y < 0.0 ? near : far),
          f.centre_px.x + hi.x * (hi.x < 0.0 ? far : near),
          f.centre_px.y + hi.y * (hi.y < 0.0 ? far : near),
          1.0 / lo.z,
          true};
}

}  // namespace sunfleck
