// Steps fall into the intervals of the finest kind; coarser kinds are sums of rows.

#include "lighting/sky/sky_weights.h"

#include <algorithm>
#include <cmath>

#include "lighting/sky/weight_parts.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

void append_row(SparseRows& rows, const std::vector<double>& dense) {
  for (std::size_t c = 0; c < dense.size(); ++c) {
    if (dense[c] == 0.0) continue;
    rows.column.push_back(static_cast<std::uint32_t>(c));
    rows.value.push_back(dense[c]);
  }
  rows.row_begin.push_back(rows.column.size());
}

// Radiance of the sky over a run of steps, per patch.
class SkySum {
 public:
  SkySum(const HemisphereGrid& grid, SkyModel model) : grid_(grid), points_(sky_points(grid)), model_(model) {
    if (model != SkyModel::kPerez) round_ = patch_radiance(SkyRadiance(model), grid, points_);
  }

  std::vector<double> over(std::span<const SunStep> steps) const {
    std::vector<double> sum(grid_.size(), 0.0);
    if (model_ == SkyModel::kPerez) {
      for (std::size_t first = 0; first < steps.size();) {
        const std::size_t last = end_of_run(steps, first);
        add_weather(steps.subspan(first, last - first), sum);
        first = last;
      }
      return sum;
    }
    double diffuse_j_m2 = 0;
    for (const SunStep& step : steps) diffuse_j_m2 += step.diffuse_horizontal_j_m2;
    for (std::size_t p = 0; p < sum.size(); ++p) sum[p] = diffuse_j_m2 * round_[p];
    return sum;
  }

 private:
  // Steps of at most half an hour share one sky: the sun moves 7.5 degrees, less than a patch.
  static std::size_t end_of_run(std::span<const SunStep> steps, std::size_t first) {
    constexpr double kRunS = 1800.0 - 1e-3;
    std::size_t last = first + 1;
    while (last < steps.size() && steps[last].middle_s - steps[first].middle_s < kRunS) ++last;
    return last;
  }

  void add_weather(std::span<const SunStep> run, std::vector<double>& sum) const {
    double beam = 0, diffuse = 0, extraterrestrial = 0;
    Vec3 to_sun(0.0);
    for (const SunStep& step : run) {
      beam += step.beam_normal_j_m2;
      diffuse += step.diffuse_horizontal_j_m2;
      extraterrestrial += step.extraterrestrial_normal_w_m2 * step.duration_s;
      to_sun += step.diffuse_horizontal_j_m2 * step.to_sun;
    }
    if (!(diffuse > 0.0)) return;
    const auto radiance =
        patch_radiance(perez_sky(glm::normalize(to_sun), beam, diffuse, extraterrestrial), grid_, points_);
    for (std::size_t p = 0; p < sum.size(); ++p) sum[p] += diffuse * radiance[p];
  }

  const HemisphereGrid& grid_;
  HemisphereGrid::Points points_;
  SkyModel model_;
  std::vector<double> round_;
};

// First step of each interval, and one past the last.
std::vector<std::size_t> steps_of(const std::vector<WeightInterval>& intervals,
                                  const std::vector<SunStep>& steps) {
  std::vector<std::size_t> first{0};
  for (const WeightInterval& interval : intervals) {
    std::size_t i = first.back();
    while (i < steps.size() && steps[i].middle_s < interval.end_s) ++i;
    first.push_back(i);
  }
  first.back() = steps.size();
  return first;
}

IntervalWeights finest_weights(const RadiationSeries& series, const SunBins& bins, const HemisphereGrid& grid,
                               const SkyWeightOptions& options, const RunControl& control) {
  IntervalWeights weights;
  // A whole period or month is built from days, so that there is work to share.
  weights.kind = options.finest == IntervalKind::kHour ? IntervalKind::kHour : IntervalKind::kDay;
  weights.intervals = intervals_of(weights.kind, series.period);
  const std::size_t count = weights.intervals.size();
  const std::vector<std::size_t> first = steps_of(weights.intervals, series.steps);
  const SkySum sky(grid, options.sky);
  std::vector<std::vector<double>> radiance(count);
  for_each_chunk(count, 4, control, "sky weights", [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      radiance[i] = sky.over(std::span(series.steps).subspan(first[i], first[i + 1] - first[i]));
  });
  std::vector<double> beam(bins.to_sun.size());
  for (std::size_t i = 0; i < count; ++i) {
    std::fill(beam.begin(), beam.end(), 0.0);
    double direct = 0, diffuse = 0;
    for (std::size_t s = first[i]; s < first[i + 1]; ++s) {
      const SunStep& step = series.steps[s];
      diffuse += step.diffuse_horizontal_j_m2;
      if (bins.bin_of_step[s] == kNoBin) continue;
      direct += step.beam_normal_j_m2 * step.to_sun.z;
      beam[bins.bin_of_step[s]] += step.beam_normal_j_m2 * step.to_sun.z / bins.to_sun[bins.bin_of_step[s]].z;
    }
    append_row(weights.beam_normal_j_m2, beam);
    append_row(weights.sky_radiance_j_m2_sr, radiance[i]);
    weights.direct_horizontal_j_m2.push_back(direct);
    weights.diffuse_horizontal_j_m2.push_back(diffuse);
    radiance[i] = {};
  }
  return weights;
}

SparseRows summed_rows(const SparseRows& fine, const std::vector<std::size_t>& first, std::size_t columns) {
  SparseRows rows;
  std::vector<double> dense(columns);
  for (std::size_t r = 0; r + 1 < first.size(); ++r) {
    std::fill(dense.begin(), dense.end(), 0.0);
    for (std::size_t i = fine.row_begin[first[r]]; i < fine.row_begin[first[r + 1]]; ++i)
      dense[fine.column[i]] += fine.value[i];
    append_row(rows, dense);
  }
  return rows;
}

// Rows of `fine` added up to a coarser kind.
IntervalWeights summed(const IntervalWeights& fine, IntervalKind kind, const TimeSpan& period,
                       const SkyWeights& basis) {
  IntervalWeights weights;
  weights.kind = kind;
  weights.intervals = intervals_of(kind, period);
  std::vector<std::size_t> first{0};
  for (const WeightInterval& interval : weights.intervals) {
    std::size_t i = first.back();
    double direct = 0, diffuse = 0;
    for (; i < fine.intervals.size() && fine.intervals[i].begin_s < interval.end_s; ++i) {
      direct += fine.direct_horizontal_j_m2[i];
      diffuse += fine.diffuse_horizontal_j_m2[i];
    }
    first.push_back(i);
    weights.direct_horizontal_j_m2.push_back(direct);
    weights.diffuse_horizontal_j_m2.push_back(diffuse);
  }
  weights.beam_normal_j_m2 = summed_rows(fine.beam_normal_j_m2, first, basis.to_sun.size());
  weights.sky_radiance_j_m2_sr = summed_rows(fine.sky_radiance_j_m2_sr, first, basis.sky.size());
  return weights;
}

void check_angle(double value_deg, const char* name) {
  if (!(value_deg >= 1.0 && value_deg <= 30.0))
    throw_invalid(std::string("sky_weights.") + name, "is outside [1, 30]",
                  "an angle in degrees, smaller is finer");
}

}  // namespace

double SparseRows::dot(std::size_t row, std::span<const double> response) const {
  SUNFLECK_EXPECTS(row < rows());
  double sum = 0;
  for (std::size_t i = row_begin[row]; i < row_begin[row + 1]; ++i) sum += value[i] * response[column[i]];
  return sum;
}

SkyWeights sky_weights(const RadiationSeries& series, const SkyWeightOptions& options,
                       const RunControl& control) {
  check_angle(options.patch_deg, "patch_deg");
  check_angle(options.bin_deg, "bin_deg");
  const HemisphereGrid grid = HemisphereGrid::equal_area(options.patch_deg);
  SunBins bins = sun_bins(series, options.bin_deg);
  IntervalWeights fine = finest_weights(series, bins, grid, options, control);
  SkyWeights weights;
  weights.sky = grid.directions();
  weights.to_sun = std::move(bins.to_sun);
  weights.sun_half_angle_rad = std::move(bins.half_angle_rad);
  weights.bin_spread_deg = bins.spread_deg;
  if (options.finest == IntervalKind::kHour) {
    weights.hours = std::move(fine);
    fine = summed(weights.hours, IntervalKind::kDay, series.period, weights);
  }
  weights.months = summed(fine, IntervalKind::kMonth, series.period, weights);
  weights.period = summed(weights.months, IntervalKind::kPeriod, series.period, weights);
  if (options.finest >= IntervalKind::kDay) weights.days = std::move(fine);
  if (options.finest == IntervalKind::kPeriod) weights.months = {};
  return weights;
}

}  // namespace sunfleck
