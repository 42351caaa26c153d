#include "lighting/sky/weight_parts.h"

#include <algorithm>
#include <cmath>

namespace sunfleck {
namespace {

// Begin of the interval after the one that holds `time_s`.
double next_begin_s(IntervalKind kind, const TimeSpan& period, double time_s) {
  const int day = local_day(time_s, period.offset_minutes);
  const double midnight_s = day_begin_s(day, period.offset_minutes);
  switch (kind) {
    case IntervalKind::kPeriod:
      break;
    case IntervalKind::kMonth: {
      const CivilDate date = date_of_day(day);
      const CivilDate next =
          date.month == 12 ? CivilDate{date.year + 1, 1, 1} : CivilDate{date.year, date.month + 1, 1};
      return day_begin_s(day_number(next), period.offset_minutes);
    }
    case IntervalKind::kDay:
      return midnight_s + 86400.0;
    case IntervalKind::kHour:
      return midnight_s + 3600.0 * (std::floor((time_s - midnight_s) / 3600.0) + 1.0);
  }
  return period.end_s;
}

std::string label_of(IntervalKind kind, const TimeSpan& period, double begin_s) {
  const std::string time = local_time_text(begin_s, period.offset_minutes);
  switch (kind) {
    case IntervalKind::kPeriod:
      return time + "/" + local_time_text(period.end_s, period.offset_minutes);
    case IntervalKind::kMonth:
      return time.substr(0, 7);
    case IntervalKind::kDay:
      return time.substr(0, 10);
    case IntervalKind::kHour:
      break;
  }
  return time;
}

}  // namespace

SunBins sun_bins(const RadiationSeries& series, double bin_deg) {
  const HemisphereGrid grid = HemisphereGrid::equal_area(bin_deg);
  std::vector<Vec3> energy(grid.size(), Vec3(0.0));
  SunBins bins;
  bins.bin_of_step.assign(series.steps.size(), kNoBin);
  for (std::size_t i = 0; i < series.steps.size(); ++i) {
    const SunStep& step = series.steps[i];
    if (!(step.beam_normal_j_m2 > 0.0)) continue;
    const std::size_t patch = grid.patch_of(step.to_sun);
    bins.bin_of_step[i] = static_cast<std::uint32_t>(patch);
    energy[patch] += step.beam_normal_j_m2 * step.to_sun;
  }
  std::vector<std::uint32_t> compact(grid.size(), kNoBin);
  for (std::size_t p = 0; p < grid.size(); ++p) {
    if (!(energy[p].z > 0.0)) continue;
    compact[p] = static_cast<std::uint32_t>(bins.to_sun.size());
    bins.to_sun.push_back(glm::normalize(energy[p]));
  }
  // Mean squares of the angle between the sun and its bin; an even disc of radius R has R^2 / 2.
  std::vector<double> square(bins.to_sun.size(), 0.0), total(bins.to_sun.size(), 0.0);
  for (std::size_t i = 0; i < series.steps.size(); ++i) {
    if (bins.bin_of_step[i] == kNoBin) continue;
    const std::uint32_t bin = bins.bin_of_step[i] = compact[bins.bin_of_step[i]];
    const Vec3 apart = series.steps[i].to_sun - bins.to_sun[bin];
    square[bin] += series.steps[i].beam_normal_j_m2 * glm::dot(apart, apart);
    total[bin] += series.steps[i].beam_normal_j_m2;
  }
  double all_square = 0, all = 0;
  for (std::size_t b = 0; b < bins.to_sun.size(); ++b) {
    bins.half_angle_rad.push_back(std::sqrt(2.0 * square[b] / total[b]));
    all_square += square[b];
    all += total[b];
  }
  bins.spread_deg = all > 0.0 ? degrees_from_radians(std::sqrt(all_square / all)) : 0.0;
  return bins;
}

std::vector<WeightInterval> intervals_of(IntervalKind kind, const TimeSpan& period) {
  std::vector<WeightInterval> intervals;
  for (double begin_s = period.begin_s; begin_s < period.end_s;) {
    const double end_s = std::min(period.end_s, next_begin_s(kind, period, begin_s));
    intervals.push_back({begin_s, end_s, label_of(kind, period, begin_s)});
    begin_s = end_s;
  }
  return intervals;
}

}  // namespace sunfleck
