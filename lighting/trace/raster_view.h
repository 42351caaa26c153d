// The picture plane of the sun: where a point falls in pixels and how near it is to the sun, both linear in
// its place. Without a period the plane lies across the beam, turned and shifted at random. With one it is the
// ground plane along the sun's rays: a whole number of pixels per period, so that all copies of the forest
// fall onto the same picture and their depth (way along the ray down to the plane) still orders them.
#pragma once

#include <cstdint>

#include "sim/base/random.h"
#include "sim/forest/forest.h"

namespace sunfleck::trace {

struct RasterView {
  Vec3 centre_m{0};  // coordinates below are from here
  Vec3 to_sun{0, 0, 1};
  Vec3 u_per_m{0}, v_per_m{0};  // gradients of the pixel coordinates: constant along to_sun
  Vec3 s_per_m{0};              // of the depth; 1 along to_sun, larger is nearer to the sun
  double u_shift = 0, v_shift = 0;
  Vec3 u_step_m{0}, v_step_m{0};  // one pixel aside at the same depth
  double pixel_area_m2 = 0;       // across the beam
  bool wraps = false;
  std::int32_t u_count = 0, v_count = 0;  // pixels of the period
  // Depth of the ground at a pixel's coordinates; -infinity without ground.
  double ground_s = 0, ground_s_per_u = 0, ground_s_per_v = 0;
};

// Lowest sine of the sun's height over the plane of a period.
inline constexpr double kLowestClimb = 1e-4;

// How fast height above the ground plane grows along a direction.
double climb_of(const Terrain& terrain, const Vec3& direction);

// `bounds` of the forest, not empty. `to_sun` with climb_of > 0 where there is ground.
RasterView make_view(const Forest& forest, const Box& bounds, const Vec3& to_sun, double pixel_m, bool ground,
                     RandomStream random);

}  // namespace sunfleck::trace
