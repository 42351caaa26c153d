// See sweep_row.h.
#include "lighting/transport/sweep_row.h"

namespace sunfleck::transport {

namespace {

// Of an exponential between its two ends, by Simpson's rule: 3e-5 of its range off at depth 1.
[[gnu::always_inline]] inline float mean_of(float arriving, float middle, float leaving) {
  return middle + (1.0f / 6.0f) * ((arriving - middle) + (leaving - middle));
}

template <bool kMean>
[[gnu::always_inline]] inline void sweep_cells_of(const Row& row) {
  const RowWeights w = row.weights;
  const int count = row.count;
  const float* __restrict in = row.in;
  const float* __restrict across = row.in_across;
  const float* __restrict pass = row.pass;
  float* __restrict cell = row.cell;
  float* __restrict out = row.out;
  for (int i = 0; i < count; ++i) {
    const float arriving =
        w.near * in[i] + w.next * in[i + 1] + w.across * across[i] + w.both * across[i + 1];
    const float source = cell[i];
    const float radiance = source + (arriving - source) * pass[i];
    const float leaving = source + (radiance - source) * pass[i];
    cell[i] = kMean ? mean_of(arriving, radiance, leaving) : radiance;
    out[i] = leaving;
  }
}

[[gnu::always_inline]] inline void sweep_cells(const Row& row) {
  if (row.mean)
    sweep_cells_of<true>(row);
  else
    sweep_cells_of<false>(row);
}

[[gnu::target("avx512f,avx512vl,avx512bw,avx512dq,prefer-vector-width=512")]] void sweep_row_avx512(
    const Row& row) {
  sweep_cells(row);
}

}  // namespace

void sweep_row_plain(const Row& row) { sweep_cells(row); }

SweepRow sweep_row_best() {
  const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                    __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq");
  return wide ? sweep_row_avx512 : sweep_row_plain;
}

void sweep_row_apart(const Row& row, std::ptrdiff_t stride) {
  const RowWeights w = row.weights;
  for (int i = 0; i < row.count; ++i) {
    const float arriving = w.near * row.in[i] + w.next * row.in[i + 1] + w.across * row.in_across[i] +
                           w.both * row.in_across[i + 1];
    const float source = row.cell[i * stride], pass = row.pass[i * stride];
    const float radiance = source + (arriving - source) * pass;
    const float leaving = source + (radiance - source) * pass;
    row.cell[i * stride] = row.mean ? mean_of(arriving, radiance, leaving) : radiance;
    row.out[i] = leaving;
  }
}

}  // namespace sunfleck::transport
