// See march_lanes.h.
#include "lighting/depth/march_lanes.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "lighting/depth/grid_march.h"
#include "sim/base/contract.h"

namespace sunfleck {

namespace {

constexpr float kNever = 1e30f;  // the next face along an axis a ray does not move on

typedef float Wide __attribute__((vector_size(kMarchLanes * sizeof(float))));
typedef std::int32_t WideInt __attribute__((vector_size(kMarchLanes * sizeof(float))));

// Where sixteen rays are along one axis.
struct Walks {
  alignas(64) std::array<float, kMarchLanes> next_face_m;
  alignas(64) std::array<float, kMarchLanes> cells_left;  // before the border
};

struct Group {
  std::array<Walks, 3> axes;
  alignas(64) std::array<std::int32_t, kMarchLanes> cell{};
  alignas(64) std::array<float, kMarchLanes> own_per_m{};
};

void start_axis(const MarchLine::Axis& axis, double point_m, std::int32_t place, std::size_t lane,
                Walks& walks) {
  walks.cells_left[lane] = static_cast<float>(axis.upwards ? axis.cells - 1 - place : place);
  const double face_m = axis.lo_m + (place + axis.upwards) * axis.cell_m;
  walks.next_face_m[lane] =
      axis.per_along == 0.0 ? kNever : static_cast<float>(std::max(0.0, (face_m - point_m) * axis.per_along));
}

// Lanes without a ray walk with the first.
void start(const MarchLine& line, std::span<const MarchStart> starts, Group& group) {
  for (std::size_t lane = 0; lane < kMarchLanes; ++lane) {
    const MarchStart& s = starts[lane < starts.size() ? lane : 0];
    std::int32_t rest = static_cast<std::int32_t>(s.cell);
    for (std::size_t a = 0; a < 3; ++a) {
      start_axis(line.axes[a], s.point_m[static_cast<int>(a)], rest % line.axes[a].cells, lane,
                 group.axes[a]);
      rest /= line.axes[a].cells;
    }
    group.cell[lane] = static_cast<std::int32_t>(s.cell);
    group.own_per_m[lane] = s.own_per_m;
  }
}

template <class Vector, class Array>
[[gnu::always_inline]] inline void load(Vector& vector, const Array& array) {
  std::memcpy(&vector, array.data(), sizeof vector);
}

// Sixteen rays along one axis in registers. All numbers are floats, and every comparison decides one choice
// alone: the compiler takes other choices apart lane by lane.
struct WideAxis {
  Wide next_face_m, step_m, cells_left, cells;
  Wide stride, around;  // in the flat index: to the next cell, and back around a repeating grid
};

[[gnu::always_inline]] inline void load_axis(WideAxis& wide, const MarchLine::Axis& axis,
                                             const Walks& walks) {
  const Wide zero = {};
  load(wide.next_face_m, walks.next_face_m);
  load(wide.cells_left, walks.cells_left);
  wide.step_m = zero + axis.step_m;
  wide.cells = zero + static_cast<float>(axis.cells);
  wide.stride = zero + static_cast<float>(axis.stride);
  wide.around = zero - static_cast<float>(axis.stride * axis.cells);
}

// Rays that are at their next face along the axis step into the next cell. Through an edge or a corner they
// step along several axes at once.
[[gnu::always_inline]] inline void step(WideAxis& axis, const Wide& face_m, Wide& move) {
  const Wide zero = {}, one = zero + 1.0f;
  const Wide steps = axis.next_face_m <= face_m ? one : zero;
  move += steps * axis.stride;
  axis.cells_left -= steps;
  axis.next_face_m += steps * axis.step_m;
}

// Back to the other side of a repeating grid where the border was passed.
[[gnu::always_inline]] inline void wrap(WideAxis& axis, Wide& move, Wide& wraps) {
  const Wide zero = {}, one = zero + 1.0f;
  const Wide out = axis.cells_left < zero ? one : zero;
  move += out * axis.around;
  wraps += out;
  axis.cells_left += out * axis.cells;
}

[[gnu::always_inline]] inline void look_up(const float* extinction_per_m, const WideInt& cell, Wide& per_m) {
  alignas(64) std::array<std::int32_t, kMarchLanes> at;
  alignas(64) std::array<float, kMarchLanes> found;
  std::memcpy(at.data(), &cell, sizeof cell);
  for (std::size_t lane = 0; lane < kMarchLanes; ++lane) found[lane] = extinction_per_m[at[lane]];
  load(per_m, found);
}

[[gnu::always_inline]] inline bool any_left(const Wide& alive) {
  std::array<std::uint64_t, kMarchLanes / 2> pairs;
  std::memcpy(pairs.data(), &alive, sizeof alive);
  std::uint64_t any = 0;
  for (const std::uint64_t pair : pairs) any |= pair;
  return any != 0;
}

template <bool kWraps>
[[gnu::always_inline]] inline void walk(const MarchLine& line, const Group& group, Wide& depth) {
  constexpr int kStepsPerLook = 4;
  const Wide zero = {}, deepest = zero + static_cast<float>(kLargestDepth),
             most_wraps = zero + static_cast<float>(kMostWraps);
  WideAxis x, y, z;
  load_axis(x, line.axes[0], group.axes[0]);
  load_axis(y, line.axes[1], group.axes[1]);
  load_axis(z, line.axes[2], group.axes[2]);
  Wide own, gone_m = {}, wraps = {}, alive = zero + 1.0f;
  WideInt cell;
  load(own, group.own_per_m);
  load(cell, group.cell);
  depth = zero;
  for (int i = 1; i % kStepsPerLook != 0 || any_left(alive); ++i) {
    Wide per_m;
    look_up(line.extinction_per_m.data(), cell, per_m);
    per_m -= own;
    per_m = per_m > zero ? per_m : zero;
    own = zero;
    Wide face_m = x.next_face_m < y.next_face_m ? x.next_face_m : y.next_face_m;
    face_m = z.next_face_m < face_m ? z.next_face_m : face_m;
    depth += alive * per_m * (face_m - gone_m);
    gone_m = face_m;
    Wide move = {};
    step(x, face_m, move);
    step(y, face_m, move);
    step(z, face_m, move);
    Wide least = z.cells_left;
    if (kWraps) {
      wrap(x, move, wraps);
      wrap(y, move, wraps);
      least = least < most_wraps - wraps ? least : most_wraps - wraps;
      least = least < deepest - depth ? least : deepest - depth;
    } else {
      least = least < x.cells_left ? least : x.cells_left;
      least = least < y.cells_left ? least : y.cells_left;
    }
    const Wide inside = least >= zero ? zero + 1.0f : zero;
    alive *= inside;
    cell += __builtin_convertvector(move, WideInt);
    cell *= __builtin_convertvector(alive, WideInt);  // those that are done stay somewhere inside
  }
}

[[gnu::always_inline]] inline void march(const MarchLine& line, std::span<const MarchStart> starts,
                                         float* depths) {
  Group group;
  start(line, starts, group);
  Wide depth;
  if (line.wraps_xy)
    walk<true>(line, group, depth);
  else
    walk<false>(line, group, depth);
  for (std::size_t lane = 0; lane < starts.size(); ++lane)
    depths[lane] = std::min(depth[lane], static_cast<float>(kLargestDepth));
}

[[gnu::target("avx512f,avx512vl,avx512bw,avx512dq,prefer-vector-width=512")]] void march_group_avx512(
    const MarchLine& line, std::span<const MarchStart> starts, float* depths) {
  march(line, starts, depths);
}

}  // namespace

bool lanes_can_march(const GridLayout& layout) {
  constexpr std::size_t kWholeFloats = 1ull << 24;
  return layout.cell_count() < (1ull << 31) &&
         static_cast<std::size_t>(layout.cells[0]) * static_cast<std::size_t>(layout.cells[1]) <
             kWholeFloats / 4;
}

MarchLine march_line(const GridLayout& layout, std::span<const float> extinction_per_m,
                     const Vec3& direction) {
  SUNFLECK_EXPECTS(lanes_can_march(layout));
  MarchLine line{.axes = {}, .extinction_per_m = extinction_per_m, .wraps_xy = layout.wraps_xy};
  std::int32_t stride = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto i = static_cast<int>(a);
    const double along = direction[i];
    MarchLine::Axis& axis = line.axes[a];
    axis.lo_m = layout.lo_m[i];
    axis.cell_m = layout.cell_m[i];
    axis.cells = layout.cells[a];
    axis.upwards = along > 0.0 ? 1 : 0;
    axis.stride = axis.upwards ? stride : -stride;
    stride *= layout.cells[a];
    if (std::abs(along) < 1e-9) continue;
    axis.per_along = 1.0 / along;
    axis.step_m = static_cast<float>(layout.cell_m[i] / std::abs(along));
  }
  return line;
}

void march_group_v3(const MarchLine& line, std::span<const MarchStart> starts, float* depths) {
  march(line, starts, depths);
}

MarchGroup march_group_best() {
  const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                    __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq");
  return wide ? march_group_avx512 : march_group_v3;
}

}  // namespace sunfleck
