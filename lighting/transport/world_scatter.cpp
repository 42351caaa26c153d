// See world_scatter.h.
#include "lighting/transport/world_scatter.h"

#include "lighting/transport/wide_lanes.h"

namespace sunfleck::transport {

namespace {

// Faces alike: the sum of a pair of directions and its difference scatter each by itself, half the work.
[[gnu::always_inline]] inline void add_alike(const WorldEntry& entry, const KindKernel& kernel,
                                             const Lanes& sum, const Lanes& difference, float sun_w_m2,
                                             WideLanes& near, WideLanes& far) {
  WideLanes even = {}, odd = {}, column;
  for (std::size_t k = 0; k < kMostHalf; ++k) {
    std::memcpy(&column, kernel.even[k].data(), sizeof column);
    even += sum[k] * column;
    std::memcpy(&column, kernel.odd[k].data(), sizeof column);
    odd += difference[k] * column;
  }
  WideLanes sun_near, sun_far;
  std::memcpy(&sun_near, kernel.sun_source.data(), sizeof sun_near);
  std::memcpy(&sun_far, kernel.sun_source.data() + kLanes, sizeof sun_far);
  near += entry.area_m2 * (even + odd + sun_w_m2 * sun_near);
  far += entry.area_m2 * (even - odd + sun_w_m2 * sun_far);
}

[[gnu::always_inline]] inline void add_unlike(const WorldEntry& entry, const KindKernel& kernel,
                                              const BothLanes& radiance, float sun_w_m2, WideLanes& near,
                                              WideLanes& far) {
  WideLanes sum_near, sum_far, column;
  std::memcpy(&sum_near, kernel.sun_source.data(), sizeof sum_near);
  std::memcpy(&sum_far, kernel.sun_source.data() + kLanes, sizeof sum_far);
  sum_near *= sun_w_m2;
  sum_far *= sun_w_m2;
  for (std::size_t k = 0; k < kBothLanes; ++k) {
    if (k % kLanes >= kMostHalf) continue;
    std::memcpy(&column, kernel.source[k].data(), sizeof column);
    sum_near += radiance[k] * column;
    std::memcpy(&column, kernel.source[k].data() + kLanes, sizeof column);
    sum_far += radiance[k] * column;
  }
  near += entry.area_m2 * sum_near;
  far += entry.area_m2 * sum_far;
}

[[gnu::always_inline]] inline void scatter_cell(std::span<const WorldEntry> entries,
                                                const KindKernel* kernels, const BothLanes& radiance,
                                                float sun_w_m2, BothLanes& source) {
  Lanes sum, difference;
  for (std::size_t k = 0; k < kLanes; ++k) {
    sum[k] = radiance[k] + radiance[kLanes + k];
    difference[k] = radiance[k] - radiance[kLanes + k];
  }
  WideLanes near, far;
  std::memcpy(&near, source.data(), sizeof near);
  std::memcpy(&far, source.data() + kLanes, sizeof far);
  for (const WorldEntry& entry : entries) {
    const KindKernel& kernel = kernels[entry.kind];
    if (kernel.faces_alike)
      add_alike(entry, kernel, sum, difference, sun_w_m2, near, far);
    else
      add_unlike(entry, kernel, radiance, sun_w_m2, near, far);
  }
  std::memcpy(source.data(), &near, sizeof near);
  std::memcpy(source.data() + kLanes, &far, sizeof far);
}

void scatter_cell_v3(std::span<const WorldEntry> entries, const KindKernel* kernels,
                     const BothLanes& radiance, float sun_w_m2, BothLanes& source) {
  scatter_cell(entries, kernels, radiance, sun_w_m2, source);
}

[[gnu::target("avx512f,avx512vl,avx512bw,avx512dq,prefer-vector-width=512")]] void scatter_cell_avx512(
    std::span<const WorldEntry> entries, const KindKernel* kernels, const BothLanes& radiance, float sun_w_m2,
    BothLanes& source) {
  scatter_cell(entries, kernels, radiance, sun_w_m2, source);
}

}  // namespace

void scatter_cell_plain(std::span<const WorldEntry> entries, const KindKernel* kernels,
                        const BothLanes& radiance, float sun_w_m2, BothLanes& source) {
  for (const WorldEntry& entry : entries) {
    const KindKernel& kernel = kernels[entry.kind];
    for (std::size_t j = 0; j < kBothLanes; ++j) {
      float sum = sun_w_m2 * kernel.sun_source[j];
      for (std::size_t k = 0; k < kBothLanes; ++k) sum += radiance[k] * kernel.source[k][j];
      source[j] += entry.area_m2 * sum;
    }
  }
}

ScatterCell scatter_cell_best() {
  const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                    __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq");
  return wide ? scatter_cell_avx512 : scatter_cell_v3;
}

}  // namespace sunfleck::transport
