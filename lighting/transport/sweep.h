// Carries radiance through the grid along one direction, slab by slab along the axis in which the direction
// crosses the fewest cells sideways.
//
// Radiance lives at cell centres. From the centre plane of one slab to that of the next light passes half a
// cell, is looked up bilinearly between four columns, and passes half a cell again; in a cell
//   I = q + (I_in - q) t,  t = exp(-extinction * half the step),
// with the source function q = source / extinction. Never negative, never above its sources; light that is
// the same everywhere stays so exactly.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "lighting/depth/grid_layout.h"
#include "sim/base/run_control.h"

namespace sunfleck::transport {

struct SweepPlan {
  int axis = 2, row = 0, column = 1;  // across slabs; within a slab along and across rows
  std::array<int, 3> cells{};
  std::array<std::ptrdiff_t, 3> stride{};  // of neighbouring cells, in the flat index
  std::array<bool, 3> wraps{};
  bool from_high_end = false;           // light comes from the end with the largest index
  int row_shift = 0, column_shift = 0;  // first of the two columns looked up: -1 or 0 cells
  float row_part = 0, column_part = 0;  // weight of the second
  double step_m = 0;                    // way from slab to slab
};

// `towards`: direction to where light comes from in the frame of the layout, its parameter in metres.
SweepPlan plan_sweep(const GridLayout& layout, const Vec3& towards);

// Radiance that comes in from outside: of the cell with these indexes, at least one of them -1 or the number
// of cells.
class Inflow {
 public:
  virtual ~Inflow() = default;
  virtual float radiance(const std::array<int, 3>& cell) const = 0;
};
class NoInflow final : public Inflow {
 public:
  float radiance(const std::array<int, 3>&) const override { return 0.0f; }
};

// What a cell's radiance is on return: that in its middle, for looking up between cells, or the mean along
// the ray, by which what the cell's leaves take is what the ray loses there.
enum class CellValue { kMiddle, kMean };

// `radiance`: the source function on entry, the radiance on return. `half_step_transmittance`: t. `around`:
// where the axis wraps, what leaves the last slab; on entry what enters the first, else empty.
void sweep(const SweepPlan& plan, std::span<const float> half_step_transmittance, const Inflow& inflow,
           std::span<float> radiance, std::vector<float>& around, const RunControl& control,
           CellValue value = CellValue::kMiddle);

}  // namespace sunfleck::transport
