// See box_sweep.h.
#include "lighting/canopy/box_sweep.h"

#include <algorithm>
#include <cmath>

#include "lighting/canopy/exp_lanes.h"
#include "sim/base/contract.h"
#include "sim/base/random.h"

namespace sunfleck {

namespace {

// Light left after each box of a row, and, added to `taken`, the share of it that is taken per depth: for a
// box of depth t, (1 - exp(-t)) / t of what arrives. `part`: of the boxes' depth.
void pass_parts(std::int64_t count, float part, const float* box, float* light, float* taken) {
  for (std::int64_t i = 0; i < count; ++i) {
    const float depth = part * box[i], left = exp_of_minus(depth);
    const float share = depth > 1e-3f ? (1.0f - left) / depth : 1.0f - 0.5f * depth;
    taken[i] += part * light[i] * share;
    light[i] *= left;
  }
}

// The same for light that crosses the layer at once: what is taken takes the depth's place.
void pass_whole_boxes(std::int64_t count, float* box, float* light) {
  for (std::int64_t i = 0; i < count; ++i) {
    const float depth = box[i], left = exp_of_minus(depth);
    const float share = depth > 1e-3f ? (1.0f - left) / depth : 1.0f - 0.5f * depth;
    box[i] = light[i] * share;
    light[i] *= left;
  }
}

constexpr double kMostParts = 12;  // of a layer: full detail up to a zenith angle of 85 degrees

std::int64_t floor_mod(std::int64_t a, std::int64_t n) { return (a % n + n) % n; }

}  // namespace

void BoxSweep::fill_depths(double facing, std::span<const float> shown_per_area, const RunControl& control) {
  boxes_.assign(canopy_.voxel_count(), 0.0f);
  const auto per_m2 = static_cast<float>(1.0 / (canopy_.edge_m.x * canopy_.edge_m.y * facing));
  for (std::size_t k = 0; k < canopy_.order.size(); ++k) {
    if (k % 1024 == 0) control.check();
    const float factor = per_m2 * shown_per_area[canopy_.order[k]];
    for (std::size_t e = canopy_.first_entry[k]; e < canopy_.first_entry[k + 1]; ++e)
      boxes_[canopy_.entries[e].voxel] += factor * canopy_.entries[e].area_m2;
  }
}

// The ray that aims at column (x, y) crosses this part of the layer in column (x + shift_x, y + shift_y).
// A part of 1 is the whole layer.
void BoxSweep::pass_layer(std::uint32_t layer, float part, const Shift& shift) {
  const std::int64_t nx = canopy_.nx, ny = canopy_.ny;
  float* const boxes = boxes_.data() + static_cast<std::size_t>(layer) * canopy_.nx * canopy_.ny;
  const auto pass_boxes = [&](std::int64_t count, float* row, float* light, float* taken) {
    if (part == 1.0f)
      pass_whole_boxes(count, row, light);
    else
      pass_parts(count, part, row, light, taken);
  };
  for (std::int64_t y = 0; y < ny; ++y) {  // of the box
    float* const row = boxes + y * nx;
    float* const taken = taken_.data() + y * nx;
    if (canopy_.periodic) {
      float* const light = light_.data() + floor_mod(y - shift.y, ny) * nx;
      const std::int64_t first = floor_mod(-shift.x, nx);  // ray over box 0
      pass_boxes(nx - first, row, light + first, taken);
      pass_boxes(first, row + (nx - first), light, taken + (nx - first));
    } else {
      pass_boxes(nx, row, light_.data() + y * nx, taken);
    }
  }
}

// What was over box (x, y) comes to (x + by_x, y + by_y).
void BoxSweep::move_window(std::int64_t by_x, std::int64_t by_y) {
  if (by_x == 0 && by_y == 0) return;
  const std::int64_t nx = canopy_.nx, ny = canopy_.ny;
  moved_.assign(light_.size(), 1.0f);
  const std::int64_t x0 = std::max<std::int64_t>(0, by_x), x1 = std::min(nx, nx + by_x);
  for (std::int64_t y = std::max<std::int64_t>(0, by_y); y < std::min(ny, ny + by_y) && x0 < x1; ++y)
    std::copy_n(light_.data() + (y - by_y) * nx + x0 - by_x, x1 - x0, moved_.data() + y * nx + x0);
  std::swap(light_, moved_);
}

void BoxSweep::attribute(double facing, std::span<const float> shown_per_area, SweptLight& out,
                         const RunControl& control) const {
  out.intercepted_m2.assign(canopy_.order.size(), 0.0);
  for (std::size_t k = 0; k < canopy_.order.size(); ++k) {
    if (k % 1024 == 0) control.check();
    double sum = 0.0;
    for (std::size_t e = canopy_.first_entry[k]; e < canopy_.first_entry[k + 1]; ++e)
      sum += boxes_[canopy_.entries[e].voxel] * canopy_.entries[e].area_m2;
    out.intercepted_m2[canopy_.order[k]] = sum * shown_per_area[canopy_.order[k]];
  }
  const double column_m2 = facing * canopy_.edge_m.x * canopy_.edge_m.y;
  out.ground = light_;
  double sum = 0.0;
  for (const float light : light_) sum += light;
  out.to_ground_m2 = sum * column_m2;
  out.incident_m2 = static_cast<double>(light_.size()) * column_m2;
}

int BoxSweep::parts_of_a_layer(const Vec3& to_source, double facing) const {
  const Vec2 way = glm::abs(Vec2(to_source)) / canopy_.edge_m * (canopy_.height_m / facing);
  return static_cast<int>(std::clamp(std::ceil(std::max(way.x, way.y)), 1.0, kMostParts));
}

SweptLight BoxSweep::run(const Vec3& to_source, std::span<const float> shown_per_area, std::uint64_t seed,
                         const RunControl& control) {
  SUNFLECK_EXPECTS(shown_per_area.size() == canopy_.order.size());
  const double facing = canopy_.facing(to_source);
  SUNFLECK_EXPECTS(facing > 0.0);
  fill_depths(facing, shown_per_area, control);
  const int parts = parts_of_a_layer(to_source, facing);
  RandomStream random(seed, 0, RandomPurpose::kStandRays);
  light_.assign(static_cast<std::size_t>(canopy_.nx) * canopy_.ny, 1.0f);
  Shift before;
  for (std::uint32_t k = canopy_.nz; k-- > 0;) {
    control.check();
    if (parts > 1 || taken_.empty()) taken_.assign(light_.size(), 0.0f);
    for (int part = parts; part-- > 0;) {
      const double height_m = (k + (part + 0.5) / parts) * canopy_.height_m;
      const Vec2 way = Vec2(to_source) / canopy_.edge_m * (height_m / facing);
      const Shift shift{static_cast<std::int64_t>(std::floor(way.x + random.uniform())),
                        static_cast<std::int64_t>(std::floor(way.y + random.uniform()))};
      const bool topmost = k + 1 == canopy_.nz && part + 1 == parts;
      if (!canopy_.periodic && !topmost) move_window(shift.x - before.x, shift.y - before.y);
      pass_layer(k, static_cast<float>(1.0 / parts), shift);
      before = shift;
    }
    if (parts > 1)
      std::copy(taken_.begin(), taken_.end(),
                boxes_.begin() + static_cast<std::ptrdiff_t>(k * taken_.size()));
  }
  if (!canopy_.periodic) move_window(-before.x, -before.y);
  SweptLight out;
  attribute(facing, shown_per_area, out, control);
  return out;
}

}  // namespace sunfleck
