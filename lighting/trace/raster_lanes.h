// The inner loops over runs of pixels, eight pixels side by side (vector types of GCC and Clang: two or one
// instruction of any x86-64, several elsewhere). Rows must be readable, and for drawing writable, up to the
// next multiple of eight pixels from a run's begin; pixels past its end are written back as they were. The
// plain twins say what they do, pixel by pixel; a test holds them together.
#pragma once

#include <cstdint>
#include <cstring>

namespace sunfleck::trace {

inline constexpr std::int32_t kPixelLanes = 8;
using FloatLanes = float __attribute__((vector_size(4 * kPixelLanes)));
using IntLanes = std::int32_t __attribute__((vector_size(4 * kPixelLanes)));
inline constexpr IntLanes kLaneNumbers = {0, 1, 2, 3, 4, 5, 6, 7};

template <class Lanes, class T>
void load(Lanes& to, const T* from) {
  std::memcpy(&to, from, sizeof to);
}

// Pixels whose depth s + i per_pixel is nearer take it and show the record.
inline void draw_run(float* depth, std::uint32_t* shown, std::int32_t count, float s, float per_pixel,
                     std::uint32_t record) {
  const IntLanes mark = static_cast<std::int32_t>(record) - IntLanes{};
  for (std::int32_t first = 0; first < count; first += kPixelLanes) {
    const IntLanes number = kLaneNumbers + first;
    const FloatLanes here = s + per_pixel * __builtin_convertvector(number, FloatLanes);
    FloatLanes near;
    IntLanes show;
    load(near, depth + first);
    load(show, shown + first);
    const IntLanes nearer = (here > near) & (number < count);
    near = nearer ? here : near;
    show = nearer ? mark : show;
    std::memcpy(depth + first, &near, sizeof near);
    std::memcpy(shown + first, &show, sizeof show);
  }
}
inline void draw_run_plain(float* depth, std::uint32_t* shown, std::int32_t count, float s, float per_pixel,
                           std::uint32_t record) {
  for (std::int32_t i = 0; i < count; ++i) {
    const float here = s + per_pixel * static_cast<float>(i);
    if (!(here > depth[i])) continue;
    depth[i] = here;
    shown[i] = record;
  }
}

// Sums by lane.
class LaneCount {
 public:
  // Pixels that show the record.
  void add_seen(const std::uint32_t* row, std::int32_t count, std::uint32_t record) {
    for (std::int32_t first = 0; first < count; first += kPixelLanes) {
      IntLanes show;
      load(show, row + first);
      sums_ -= (show == static_cast<std::int32_t>(record)) & (kLaneNumbers + first < count);
    }
  }
  // Pairs of pixels of which one alone shows it.
  void add_changes(const std::uint32_t* one, const std::uint32_t* other, std::int32_t count,
                   std::uint32_t record) {
    const auto mark = static_cast<std::int32_t>(record);
    for (std::int32_t first = 0; first < count; first += kPixelLanes) {
      IntLanes a, b;
      load(a, one + first);
      load(b, other + first);
      sums_ -= ((a == mark) ^ (b == mark)) & (kLaneNumbers + first < count);
    }
  }
  std::uint64_t total() const {
    std::uint64_t sum = 0;
    for (int lane = 0; lane < kPixelLanes; ++lane) sum += static_cast<std::uint32_t>(sums_[lane]);
    return sum;
  }

 private:
  IntLanes sums_{};
};

inline std::uint64_t seen_plain(const std::uint32_t* row, std::int32_t count, std::uint32_t record) {
  std::uint64_t seen = 0;
  for (std::int32_t i = 0; i < count; ++i) seen += row[i] == record;
  return seen;
}
inline std::uint64_t changes_plain(const std::uint32_t* one, const std::uint32_t* other, std::int32_t count,
                                   std::uint32_t record) {
  std::uint64_t changes = 0;
  for (std::int32_t i = 0; i < count; ++i) changes += (one[i] == record) != (other[i] == record);
  return changes;
}

}  // namespace sunfleck::trace
