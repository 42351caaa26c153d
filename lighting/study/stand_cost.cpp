#include "lighting/study/stand_cost.h"

#include <algorithm>
#include <cmath>

#include "lighting/sky/sky_patches.h"

namespace sunfleck {
namespace {

constexpr double kWeightBytes = 16;  // a direction's strength in one interval
constexpr double kValueBytes = 8;    // a value and its standard error

// Numbers of what the tables are about.
struct Targets {
  double cells, trees, layers, sensors, bands;
};

double cells_of_map(const Forest& forest, const StandStudySpec& spec) {
  const Vec3 bounds = forest_bounds(forest).size();
  Vec2 size(bounds.x, bounds.y);
  if (forest.period)
    size = forest.period->size_m;
  else if (spec.map_lo_m && spec.map_hi_m)
    size = *spec.map_hi_m - *spec.map_lo_m;
  const auto across = [&](double m) { return std::max(1.0, std::ceil(m / spec.ground_cell_m)); };
  return across(size.x) * across(size.y);
}

Targets targets_of(const Forest& forest, const StandStudySpec& spec, double cells) {
  const double bands = spec.scattering ? static_cast<double>(spec.optics.bands.size()) : 0.0;
  return {cells, static_cast<double>(forest.instances.size()),
          2 + forest_bounds(forest).size().z / spec.layer_m, static_cast<double>(spec.sensors.size()), bands};
}

// StandResponse, potentials and sensors of one direction.
double response_bytes(const Targets& t) {
  return sizeof(float) *
         (t.cells * (1 + t.bands) + t.trees * (3 + t.bands) + t.layers * (3 + t.bands) + t.sensors);
}

// StandLight of one interval.
double rays_row_bytes(const Targets& t) {
  return kValueBytes * (t.cells * (3 + t.bands) + t.trees * (4 + t.bands) + t.layers * (3 + t.bands) +
                        8 * t.sensors + 8 + 9 * t.bands);
}

// LargeStandLight of one interval.
double boxes_row_bytes(const Targets& t) { return kValueBytes * (3 * t.cells + 3 * t.trees + 3); }

double boxes_bytes(const Forest& forest, const StandStudySpec& spec, const Targets& t) {
  constexpr double kPerBox = 16, kEntriesPerTree = 2000, kEntryBytes = 8;
  const double edge_m = std::max(0.1, 0.5 * spec.ground_cell_m);
  const double boxes = 4 * t.cells * std::ceil(forest_bounds(forest).size().z / edge_m);
  return kPerBox * boxes + kEntriesPerTree * kEntryBytes * t.trees;
}

}  // namespace

std::size_t interval_count(const TimeSpan& period, IntervalKind kind) {
  const double last_s = std::nextafter(period.end_s, period.begin_s);
  const int first_day = local_day(period.begin_s, period.offset_minutes);
  const int last_day = local_day(last_s, period.offset_minutes);
  const auto month = [](int day) {
    const CivilDate date = date_of_day(day);
    return 12 * date.year + date.month;
  };
  switch (kind) {
    case IntervalKind::kPeriod:
      break;
    case IntervalKind::kMonth:
      return static_cast<std::size_t>(month(last_day) - month(first_day) + 1);
    case IntervalKind::kDay:
      return static_cast<std::size_t>(last_day - first_day + 1);
    case IntervalKind::kHour: {
      const double day_s = day_begin_s(first_day, period.offset_minutes);
      return static_cast<std::size_t>(std::floor((last_s - day_s) / 3600) -
                                      std::floor((period.begin_s - day_s) / 3600) + 1);
    }
  }
  return 1;
}

StandCost predicted_cost(const Forest& forest, const StandStudySpec& asked) {
  const StandStudySpec spec = with_directions(forest, asked);
  StandCost cost;
  cost.engine = chosen_engine(forest, spec);
  cost.intervals = interval_count(spec.period, spec.intervals);
  cost.ground_cells = cells_of_map(forest, spec);
  const Targets targets = targets_of(forest, spec, cost.ground_cells);
  const double intervals = static_cast<double>(cost.intervals);
  const double patches = static_cast<double>(HemisphereGrid::equal_area(spec.patch_deg).size());
  const double bins = 0.5 * static_cast<double>(HemisphereGrid::equal_area(spec.bin_deg).size());
  const double weights = kWeightBytes * intervals * (patches + std::min(bins, 200.0));
  if (cost.engine == StandEngine::kBoxes) {
    cost.result_bytes = intervals * boxes_row_bytes(targets);
    cost.memory_bytes = 2 * weights + 2 * cost.result_bytes + boxes_bytes(forest, spec, targets);
    return cost;
  }
  const bool has_parts = spec.intervals != IntervalKind::kPeriod;
  cost.rays = spec.rays_per_cell * cost.ground_cells;
  cost.result_bytes = (has_parts ? intervals + 1 : 1) * rays_row_bytes(targets);
  cost.memory_bytes = 2 * weights + 2 * cost.result_bytes + (patches + bins) * response_bytes(targets);
  return cost;
}

}  // namespace sunfleck
