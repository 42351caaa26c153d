// See grid_march.h.
#include "lighting/depth/grid_march.h"

#include <algorithm>
#include <cmath>

namespace sunfleck {

namespace {

constexpr double kNever = 1e30;  // the next face along an axis a ray does not move on

// A ray's way along one axis; lengths count along the unmodified direction in metres.
struct AxisWalk {
  double next_face_m = kNever, face_step_m = 0;
  std::ptrdiff_t stride = 0;  // to the next cell, in the flat index
  int cells_left = 0;         // before the border

  // Steps if `here`, without a branch: which axis comes next cannot be foreseen.
  void step_if(bool here) {
    next_face_m += here ? face_step_m : 0.0;
    cells_left -= here;
  }
};

struct GridWalk {
  std::ptrdiff_t cell;  // flat index
  AxisWalk x, y, z;

  GridWalk(const GridLayout& layout, const std::array<int, 3>& start_cell, const Vec3& start_m,
           const Vec3& direction)
      : cell(layout.flat(start_cell)) {
    std::ptrdiff_t stride = 1;
    AxisWalk* walks[] = {&x, &y, &z};
    for (int axis = 0; axis < 3; ++axis) {
      AxisWalk& walk = *walks[axis];
      const double along = direction[axis];
      const int upwards = along > 0.0 ? 1 : 0;
      walk.stride = upwards ? stride : -stride;
      walk.cells_left = upwards ? layout.cells[axis] - 1 - start_cell[axis] : start_cell[axis];
      stride *= layout.cells[axis];
      if (std::abs(along) < 1e-9) continue;
      const double face = layout.lo_m[axis] + (start_cell[axis] + upwards) * layout.cell_m[axis];
      walk.next_face_m = std::max(0.0, (face - start_m[axis]) / along);
      walk.face_step_m = layout.cell_m[axis] / std::abs(along);
    }
  }
};

// Back to the other side of a repeating grid.
void wrap(AxisWalk& walk, std::ptrdiff_t& cell, int cells) {
  cell -= walk.stride * cells;
  walk.cells_left = cells - 1;
}

// Depth of a walk to the border. `own_per_m` is taken out of the first cell.
double walk_depth(const GridLayout& layout, std::span<const float> extinction_per_m, GridWalk walk,
                  float own_per_m) {
  double depth = 0.0, gone_m = 0.0;
  int wraps = 0;
  while (depth < kLargestDepth) {
    const float per_m = std::max(0.0f, extinction_per_m[static_cast<std::size_t>(walk.cell)] - own_per_m);
    own_per_m = 0.0f;
    const double face_m = std::min(std::min(walk.x.next_face_m, walk.y.next_face_m), walk.z.next_face_m);
    depth += per_m * (face_m - gone_m);
    gone_m = face_m;
    const bool along_x = walk.x.next_face_m <= face_m;
    const bool along_y = !along_x & (walk.y.next_face_m <= face_m);
    walk.x.step_if(along_x);
    walk.y.step_if(along_y);
    walk.z.step_if(!along_x & !along_y);
    walk.cell += along_x ? walk.x.stride : along_y ? walk.y.stride : walk.z.stride;
    if ((walk.x.cells_left | walk.y.cells_left | walk.z.cells_left) >= 0) continue;
    if (!layout.wraps_xy || walk.z.cells_left < 0 || ++wraps > kMostWraps) break;
    if (along_x)
      wrap(walk.x, walk.cell, layout.cells[0]);
    else
      wrap(walk.y, walk.cell, layout.cells[1]);
  }
  return std::min(depth, kLargestDepth);
}

// First point of a ray inside the grid (slab method); false if the ray misses it. Periodic axes have no
// border.
bool enter_grid(const GridLayout& layout, Vec3& point_m, const Vec3& direction) {
  double enter = 0.0, leave = kNever;
  for (int axis = layout.wraps_xy ? 2 : 0; axis < 3; ++axis) {
    const double lo = layout.lo_m[axis] - point_m[axis], hi = lo + layout.size_m()[axis];
    if (std::abs(direction[axis]) < 1e-9) {
      if (lo > 0.0 || hi < 0.0) return false;
      continue;
    }
    const double a = lo / direction[axis], b = hi / direction[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  point_m += enter * direction;
  return enter < leave;
}

}  // namespace

double march_from_cell(const GridLayout& layout, std::span<const float> extinction_per_m,
                       const std::array<int, 3>& cell, const Vec3& point_m, const Vec3& direction,
                       float own_per_m) {
  return walk_depth(layout, extinction_per_m, GridWalk(layout, cell, point_m, direction), own_per_m);
}

double march_grid(const GridLayout& layout, std::span<const float> extinction_per_m, const Vec3& point_m,
                  const Vec3& direction) {
  Vec3 start = point_m;
  if (!enter_grid(layout, start, direction)) return 0.0;
  if (layout.wraps_xy) {
    for (int axis = 0; axis < 2; ++axis) {
      const double size = layout.size_m()[axis];
      start[axis] -= size * std::floor((start[axis] - layout.lo_m[axis]) / size);
    }
  }
  return march_from_cell(layout, extinction_per_m, layout.cell_of(start), start, direction, 0.0f);
}

}  // namespace sunfleck
