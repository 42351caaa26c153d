// See extinction_grid.h.
#include "lighting/depth/extinction_grid.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/base/contract.h"
#include "sim/base/parallel.h"

namespace sunfleck {

namespace {

constexpr double kLargestCover = 0.9;  // of a cell's face by one contribution
constexpr double kNever = 1e30;        // the next face along an axis a ray does not move on

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
double walk_depth(const GridLayout& layout, const float* extinction_per_m, GridWalk walk, float own_per_m) {
  double depth = 0.0, gone_m = 0.0;
  int wraps = 0;
  while (depth < kLargestDepth) {
    const float per_m = std::max(0.0f, extinction_per_m[walk.cell] - own_per_m);
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

ExtinctionGrid::ExtinctionGrid(const BlockerField& field, const Vec3& direction, const RunControl& control)
    : field_(field) {
  turn_to(direction, control);
}

void ExtinctionGrid::turn_to(const Vec3& direction, const RunControl& control) {
  SUNFLECK_EXPECTS(std::abs(glm::dot(direction, direction) - 1.0) < 1e-6);
  direction_ = direction;
  field_direction_ = field_.field_direction(direction);
  clamped_ = 0;
  extinction_per_m_.assign(field_.layout().cell_count(), 0.0f);
  add_elements(control);
  add_wood(control);
}

float ExtinctionGrid::extinction_of(double projected_m2) const {
  const double h = field_.layout().mean_cell_m();
  const double cover = std::min(kLargestCover, projected_m2 / (h * h));
  return static_cast<float>(-std::log1p(-cover) / h);
}

void ExtinctionGrid::add_elements(const RunControl& control) {
  const auto& elements = field_.elements();
  own_extinction_per_m_.resize(elements.size());
  for_each_chunk(elements.size(), 8192, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      own_extinction_per_m_[i] = extinction_of(projected_area_m2(elements[i], direction_));
  });
  // Large elements: piece by piece; what falls in the cell of their centre is their own share.
  const double limit_m2 = kLargestCover * std::pow(field_.layout().mean_cell_m(), 2);
  std::uint32_t previous = static_cast<std::uint32_t>(elements.size());
  for (const BlockerPiece& piece : field_.element_pieces()) {
    if (piece.blocker != previous) own_extinction_per_m_[piece.blocker] = 0.0f;
    previous = piece.blocker;
    const double projected = piece.share * projected_area_m2(elements[piece.blocker], direction_);
    clamped_ += projected > limit_m2;
    const float part = extinction_of(projected);
    if (piece.cell == elements[piece.blocker].cell)
      own_extinction_per_m_[piece.blocker] += part;
    else
      extinction_per_m_[piece.cell] += part;
  }
  // In order of the elements, whatever the number of threads: sums of floats depend on it.
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (i % 65536 == 0) control.check();
    extinction_per_m_[elements[i].cell] += own_extinction_per_m_[i];
  }
}

void ExtinctionGrid::add_wood(const RunControl& control) {
  const double limit_m2 = kLargestCover * std::pow(field_.layout().mean_cell_m(), 2);
  std::size_t count = 0;
  for (const BlockerPiece& piece : field_.wood_pieces()) {
    if (++count % 65536 == 0) control.check();
    const double projected = piece.share * projected_area_m2(field_.wood()[piece.blocker], direction_);
    clamped_ += projected > limit_m2;
    extinction_per_m_[piece.cell] += extinction_of(projected);
  }
}

double ExtinctionGrid::depth_from_element(std::size_t element, March march) const {
  const FieldElement& e = field_.elements()[element];
  if (e.below_ground) return kLargestDepth;
  const GridLayout& layout = field_.layout();
  const Vec3 direction = march == March::kForward ? field_direction_ : -field_direction_;
  const GridWalk walk(layout, layout.unflat(e.cell), Vec3(e.centre_m), direction);
  return walk_depth(layout, extinction_per_m_.data(), walk, own_extinction_per_m_[element]);
}

double ExtinctionGrid::depth_from_point(const Vec3& point_m, March march) const {
  const GridLayout& layout = field_.layout();
  const Vec3 direction = march == March::kForward ? field_direction_ : -field_direction_;
  Vec3 start = field_.field_from_world(point_m);
  if (!enter_grid(layout, start, direction)) return 0.0;
  if (layout.wraps_xy) {
    for (int axis = 0; axis < 2; ++axis) {
      const double size = layout.size_m()[axis];
      start[axis] -= size * std::floor((start[axis] - layout.lo_m[axis]) / size);
    }
  }
  return walk_depth(layout, extinction_per_m_.data(),
                    GridWalk(layout, layout.cell_of(start), start, direction), 0.0f);
}

std::vector<float> ExtinctionGrid::depth_of_elements(March march, const RunControl& control) const {
  std::vector<float> depths(field_.elements().size());
  // A level ray in a periodic scene takes kMostWraps rounds: small chunks keep the stop token in sight.
  const std::size_t chunk = field_.layout().wraps_xy ? 16 : 512;
  for_each_chunk(depths.size(), chunk, control, "marching the leaf-area grid",
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t i = begin; i < end; ++i)
                     depths[i] = static_cast<float>(depth_from_element(i, march));
                 });
  return depths;
}

}  // namespace sunfleck
