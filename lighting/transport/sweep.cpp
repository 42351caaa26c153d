// See sweep.h.
#include "lighting/transport/sweep.h"

#include <algorithm>
#include <cmath>

#include "lighting/transport/sweep_row.h"
#include "sim/base/contract.h"

namespace sunfleck::transport {

namespace {

struct Lookup {
  int shift;
  float part;
};

// Cells -1, 0 or 0, 1 around a shift in [-1, 1].
Lookup lookup_of(double shift_cells) {
  const double shift = std::clamp(shift_cells, -1.0, 1.0);
  const int first = shift < 0.0 ? -1 : 0;
  return {first, static_cast<float>(shift - first)};
}

// What leaves a slab towards the next, with a rim of one cell around it.
class Plane {
 public:
  Plane(int rows, int columns)
      : pitch_(rows + 2),
        values_(static_cast<std::size_t>(rows + 2) * static_cast<std::size_t>(columns + 2)) {}
  float* at(int row, int column) { return values_.data() + (column + 1) * pitch_ + row + 1; }
  std::ptrdiff_t pitch() const { return pitch_; }

 private:
  std::ptrdiff_t pitch_;
  std::vector<float> values_;
};

class Sweeper {
 public:
  Sweeper(const SweepPlan& plan, const Inflow& inflow, CellValue value)
      : plan_(plan),
        inflow_(inflow),
        mean_(value == CellValue::kMean),
        rows_(plan.cells[static_cast<std::size_t>(plan.row)]),
        columns_(plan.cells[static_cast<std::size_t>(plan.column)]),
        slabs_(plan.cells[static_cast<std::size_t>(plan.axis)]),
        before_(rows_, columns_),
        after_(rows_, columns_) {
    const float r = plan.row_part, c = plan.column_part;
    weights_ = {(1 - r) * (1 - c), r * (1 - c), (1 - r) * c, r * c};
  }

  void run(std::span<const float> t, std::span<float> radiance, std::vector<float>& around,
           const RunControl& control) {
    enter(around);
    for (int n = 0; n < slabs_; ++n) {
      control.check();
      const int slab = plan_.from_high_end ? slabs_ - 1 - n : n;
      pass_slab(slab, t.data(), radiance.data());
      std::swap(before_, after_);
      if (n + 1 < slabs_) fill_rim(slab);
    }
    leave(around);
  }

 private:
  bool axis_wraps() const { return plan_.wraps[static_cast<std::size_t>(plan_.axis)]; }

  float outside(int slab, int row, int column) const {
    std::array<int, 3> cell{};
    cell[static_cast<std::size_t>(plan_.axis)] = slab;
    cell[static_cast<std::size_t>(plan_.row)] = row;
    cell[static_cast<std::size_t>(plan_.column)] = column;
    return inflow_.radiance(cell);
  }

  void enter(const std::vector<float>& around) {
    const int slab = plan_.from_high_end ? slabs_ : -1;
    for (int c = 0; c < columns_; ++c)
      for (int r = 0; r < rows_; ++r)
        *before_.at(r, c) = !axis_wraps() ? outside(slab, r, c)
                            : around.empty()
                                ? 0.0f
                                : around[static_cast<std::size_t>(c) * static_cast<std::size_t>(rows_) +
                                         static_cast<std::size_t>(r)];
    fill_rim(axis_wraps() ? (plan_.from_high_end ? 0 : slabs_ - 1) : slab);
  }

  void leave(std::vector<float>& around) {
    if (!axis_wraps()) return;
    around.clear();
    for (int c = 0; c < columns_; ++c)
      around.insert(around.end(), before_.at(0, c), before_.at(0, c) + rows_);
  }

  // Only the rim that lookups reach.
  void fill_rim(int slab) {
    const bool rows_wrap = plan_.wraps[static_cast<std::size_t>(plan_.row)];
    const bool columns_wrap = plan_.wraps[static_cast<std::size_t>(plan_.column)];
    const int rim_row = plan_.row_shift < 0 ? -1 : rows_, rim_column = plan_.column_shift < 0 ? -1 : columns_;
    for (int c = 0; c < columns_; ++c)
      *before_.at(rim_row, c) =
          rows_wrap ? *before_.at((rim_row + rows_) % rows_, c) : outside(slab, rim_row, c);
    for (int r = std::min(0, rim_row); r < std::max(rows_, rim_row + 1); ++r)
      *before_.at(r, rim_column) =
          columns_wrap ? *before_.at(r, (rim_column + columns_) % columns_) : outside(slab, r, rim_column);
  }

  void pass_slab(int slab, const float* t, float* radiance) {
    const std::ptrdiff_t stride = plan_.stride[static_cast<std::size_t>(plan_.row)];
    for (int c = 0; c < columns_; ++c) {
      const std::ptrdiff_t first = slab * plan_.stride[static_cast<std::size_t>(plan_.axis)] +
                                   c * plan_.stride[static_cast<std::size_t>(plan_.column)];
      const float* in = before_.at(plan_.row_shift, c + plan_.column_shift);
      const Row cells{.mean = mean_,
                      .count = rows_,
                      .in = in,
                      .in_across = in + before_.pitch(),
                      .weights = weights_,
                      .pass = t + first,
                      .cell = radiance + first,
                      .out = after_.at(0, c)};
      if (stride == 1)
        sweep_row_(cells);
      else
        sweep_row_apart(cells, stride);
    }
  }

  const SweepPlan& plan_;
  const Inflow& inflow_;
  const bool mean_;
  int rows_, columns_, slabs_;
  Plane before_, after_;
  RowWeights weights_;
  const SweepRow sweep_row_ = sweep_row_best();
};

}  // namespace

SweepPlan plan_sweep(const GridLayout& layout, const Vec3& towards) {
  SweepPlan plan;
  const Vec3 cells_per_m = towards / layout.cell_m;
  for (const int axis : {1, 0})  // the vertical wins ties
    if (std::abs(cells_per_m[axis]) > std::abs(cells_per_m[plan.axis]) * (1.0 + 1e-6)) plan.axis = axis;
  SUNFLECK_EXPECTS(cells_per_m[plan.axis] != 0.0);
  plan.row = plan.axis == 0 ? 1 : 0;
  plan.column = 3 - plan.axis - plan.row;
  plan.cells = layout.cells;
  plan.stride = {1, layout.cells[0], static_cast<std::ptrdiff_t>(layout.cells[0]) * layout.cells[1]};
  plan.wraps = {layout.wraps_xy, layout.wraps_xy, false};
  plan.from_high_end = towards[plan.axis] > 0.0;
  plan.step_m = layout.cell_m[plan.axis] / std::abs(towards[plan.axis]);
  const Lookup row = lookup_of(plan.step_m * cells_per_m[plan.row]);
  const Lookup column = lookup_of(plan.step_m * cells_per_m[plan.column]);
  plan.row_shift = row.shift;
  plan.row_part = row.part;
  plan.column_shift = column.shift;
  plan.column_part = column.part;
  return plan;
}

void sweep(const SweepPlan& plan, std::span<const float> half_step_transmittance, const Inflow& inflow,
           std::span<float> radiance, std::vector<float>& around, const RunControl& control,
           CellValue value) {
  SUNFLECK_EXPECTS(radiance.size() == half_step_transmittance.size());
  Sweeper(plan, inflow, value).run(half_step_transmittance, radiance, around, control);
}

}  // namespace sunfleck::transport
