// grid_march.h for many starts and one direction: sixteen rays at a time, each in a lane of vector registers,
// in float. Rays that start in the same cell or close by go nearly the same way, so that none waits for
// another.
//
// Depths agree with march_from_cell() to about 1e-5 of themselves (crossings of faces are known to 1e-7 of
// the way gone). A ray's depth does not depend on the others that walk with it.
#pragma once

#include <cstdint>
#include <span>

#include "lighting/depth/grid_layout.h"

namespace sunfleck {

inline constexpr std::size_t kMarchLanes = 16;

struct MarchStart {
  Vec3f point_m{0};        // inside `cell`
  std::uint32_t cell = 0;  // flat index
  float own_per_m = 0;     // taken out of the first cell
};

// Along one direction of a grid: what all rays share.
struct MarchLine {
  struct Axis {
    double lo_m = 0, cell_m = 1, per_along = 0;  // 1 / component of the direction; 0: level
    float step_m = 0;                            // from face to face, along the unmodified direction
    std::int32_t stride = 0, cells = 1, upwards = 0;
  };
  std::array<Axis, 3> axes;
  std::span<const float> extinction_per_m;
  bool wraps_xy = false;
};
// Strides are floats: less than 4 million cells in a level layer, 2^31 in all.
bool lanes_can_march(const GridLayout& layout);
// For such a layout. `direction` in the frame of the layout, not 0. `extinction_per_m` must outlive the line.
MarchLine march_line(const GridLayout& layout, std::span<const float> extinction_per_m,
                     const Vec3& direction);

// Depth to the border for at most kMarchLanes starts, in [0, kLargestDepth].
using MarchGroup = void (*)(const MarchLine& line, std::span<const MarchStart> starts, float* depths);
// The fastest form this machine runs; its plain twin is march_from_cell().
MarchGroup march_group_best();
void march_group_v3(const MarchLine& line, std::span<const MarchStart> starts, float* depths);

}  // namespace sunfleck
