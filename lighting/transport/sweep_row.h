// One row of a slab: the innermost step of a sweep (see sweep.h), in a plain form and in one for machines
// with AVX-512. Every cell is computed alone, so that all forms give the same bits but for how products are
// fused.
#pragma once

#include <cstddef>

namespace sunfleck::transport {

// Of the four columns that light comes from.
struct RowWeights {
  float near, next, across, both;
};

struct Row {
  bool mean = false;  // cells get the mean along the ray, else the value in the middle
  int count;
  const float *in, *in_across;  // what left the slab before, count + 1 values each
  RowWeights weights;
  const float* pass;  // half-step transmittance
  float* cell;        // source function on entry, radiance on return
  float* out;         // what leaves to the next slab
};

using SweepRow = void (*)(const Row& row);
// Neighbouring cells of the row lie side by side.
void sweep_row_plain(const Row& row);
// The fastest form this machine runs.
SweepRow sweep_row_best();
// Neighbouring cells lie `stride` apart.
void sweep_row_apart(const Row& row, std::ptrdiff_t stride);

}  // namespace sunfleck::transport
