// See sweep_row.h.
#include "lighting/transport/sweep_row.h"

namespace sunfleck::transport {

namespace {

[[gnu::always_inline]] inline void sweep_cells(const Row& row) {
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
    cell[i] = radiance;
    out[i] = source + (radiance - source) * pass[i];
  }
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
    row.cell[i * stride] = radiance;
    row.out[i] = source + (radiance - source) * pass;
  }
}

}  // namespace sunfleck::transport
