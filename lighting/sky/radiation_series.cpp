#include "lighting/sky/radiation_series.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "lighting/sky/radiation_blocks.h"
#include "lighting/sky/radiation_split.h"
#include "lighting/sky/sun_day.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

// Energies of a block's steps, J m-2 on the horizontal.
struct StepEnergies {
  std::vector<double> direct, diffuse;
};

double sum_of(std::span<const double> values) { return std::accumulate(values.begin(), values.end(), 0.0); }

// Scales values so that they sum to `total`; false if they are all 0.
bool scale_to(std::span<double> values, double total) {
  const double sum = sum_of(values);
  if (!(sum > 0.0)) return false;
  for (double& v : values) v *= total / sum;
  return true;
}

// Spreads a day's (or hour's) energy over its steps [first, first + count). `global_shape` is relative to
// extraterrestrial radiation. Light of a span without sun is twilight: diffuse and even.
void spread(const BlockSun& sun, std::size_t first, std::size_t count, double global_j_m2,
            double diffuse_j_m2, std::span<const double> global_shape, StepEnergies& energies) {
  const std::span<double> direct = std::span(energies.direct).subspan(first, count);
  const std::span<double> diffuse = std::span(energies.diffuse).subspan(first, count);
  const std::span<const double> outside = std::span(sun.extraterrestrial_w_m2).subspan(first, count);
  std::copy(outside.begin(), outside.end(), diffuse.begin());
  if (!scale_to(diffuse, diffuse_j_m2)) {
    std::fill(diffuse.begin(), diffuse.end(), global_j_m2 / static_cast<double>(count));
    return;
  }
  for (std::size_t i = 0; i < count; ++i) direct[i] = outside[i] * global_shape[i];
  scale_to(direct, global_j_m2);
  for (std::size_t i = 0; i < count; ++i) direct[i] = std::max(0.0, direct[i] - diffuse[i]);
  const double wanted = global_j_m2 - diffuse_j_m2;
  if (scale_to(direct, wanted)) return;
  std::copy(outside.begin(), outside.end(), direct.begin());
  scale_to(direct, wanted);
}

double block_diffuse_fraction(const RadiationBlock& block, const BlockSun& sun, const RadiationTable& table,
                              const Place& place) {
  if (block.row->diffuse_fraction) return *block.row->diffuse_fraction;
  if (!(sun.extraterrestrial_j_m2 > 0.0)) return 1.0;
  const double clearness_index = block.global_j_m2 / sun.extraterrestrial_j_m2;
  if (table.per == RadiationPer::kTime) return hourly_diffuse_fraction(clearness_index);
  const double sunset = sunset_hour_angle_rad(radians_from_degrees(place.latitude_deg),
                                              sun.sun[sun.sun.size() / 2].declination_rad);
  return table.per == RadiationPer::kDay ? daily_diffuse_fraction(clearness_index, sunset)
                                         : monthly_diffuse_fraction(clearness_index, sunset);
}

// A month or a day: day by day in proportion to extraterrestrial radiation, each by its hour angles.
void spread_days(const BlockSun& sun, double latitude_rad, double global_j_m2, double diffuse_fraction,
                 StepEnergies& energies) {
  const auto per_day = static_cast<std::size_t>(std::lround(86400.0 / sun.step_s));
  const std::size_t days = sun.sun.size() / per_day;
  std::vector<double> shape(per_day);
  for (std::size_t d = 0; d < days; ++d) {
    const std::size_t first = d * per_day;
    const double outside_j_m2 =
        sun.step_s * sum_of(std::span(sun.extraterrestrial_w_m2).subspan(first, per_day));
    const double share = sun.extraterrestrial_j_m2 > 0.0 ? outside_j_m2 / sun.extraterrestrial_j_m2
                                                         : 1.0 / static_cast<double>(days);
    const double sunset = sunset_hour_angle_rad(latitude_rad, sun.sun[first + per_day / 2].declination_rad);
    for (std::size_t i = 0; i < per_day; ++i)
      shape[i] = hourly_global_shape(sun.sun[first + i].hour_angle_rad, sunset);
    spread(sun, first, per_day, share * global_j_m2, share * global_j_m2 * diffuse_fraction, shape, energies);
  }
}

StepEnergies energies_of(const RadiationBlock& block, const BlockSun& sun, const RadiationTable& table,
                         const Place& place) {
  StepEnergies energies{std::vector<double>(sun.sun.size(), 0.0), std::vector<double>(sun.sun.size(), 0.0)};
  const double fraction = block_diffuse_fraction(block, sun, table, place);
  if (table.per != RadiationPer::kTime) {
    spread_days(sun, radians_from_degrees(place.latitude_deg), block.global_j_m2, fraction, energies);
  } else {
    const std::vector<double> even(sun.sun.size(), 1.0);
    spread(sun, 0, sun.sun.size(), block.global_j_m2, block.global_j_m2 * fraction, even, energies);
  }
  return energies;
}

// Adds the block's steps, cut to the period, to the series.
void append_steps(const RadiationBlock& block, const BlockSun& sun, const StepEnergies& energies,
                  RadiationSeries& series) {
  for (std::size_t i = 0; i < sun.sun.size(); ++i) {
    const double begin = std::max(series.period.begin_s, block.begin_s + static_cast<double>(i) * sun.step_s);
    const double end = std::min(series.period.end_s, block.begin_s + static_cast<double>(i + 1) * sun.step_s);
    const double part = (end - begin) / sun.step_s;
    double direct = part * energies.direct[i], diffuse = part * energies.diffuse[i];
    if (!(part > 1e-9) || !(direct + diffuse > 0.0)) continue;
    SunStep step{0.5 * (begin + end),
                 end - begin,
                 sun.sun[i].to_sun(),
                 0,
                 0,
                 extraterrestrial_normal_w_m2(sun.sun[i])};
    const double most = step.to_sun.z * step.duration_s *
                        most_beam_normal_w_m2(step.extraterrestrial_normal_w_m2, step.to_sun.z);
    if (direct > most) {
      series.moved_to_diffuse_j_m2 += direct - std::max(0.0, most);
      diffuse += direct - std::max(0.0, most);
      direct = std::max(0.0, most);
    }
    step.beam_normal_j_m2 = direct > 0.0 ? direct / step.to_sun.z : 0.0;
    step.diffuse_horizontal_j_m2 = diffuse;
    series.direct_horizontal_j_m2 += direct;
    series.diffuse_horizontal_j_m2 += diffuse;
    if (!block.row->diffuse_fraction) series.energy_split_by_correlation_j_m2 += direct + diffuse;
    series.steps.push_back(step);
  }
}

}  // namespace

BlockSun sun_over(const RadiationBlock& block, const Place& place, const SunTrack& track, double step_s) {
  const double length = block.end_s - block.begin_s;
  const auto count = static_cast<std::size_t>(std::max(1.0, std::ceil(length / step_s - 1e-9)));
  BlockSun result;
  result.step_s = length / static_cast<double>(count);
  result.sun.reserve(count);
  result.extraterrestrial_w_m2.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    result.sun.push_back(track.at(place, block.begin_s + (static_cast<double>(i) + 0.5) * result.step_s));
    result.extraterrestrial_w_m2.push_back(extraterrestrial_horizontal_w_m2(result.sun.back()));
  }
  result.extraterrestrial_j_m2 = result.step_s * sum_of(result.extraterrestrial_w_m2);
  return result;
}

TimeSpan parse_period(const std::string& from, const std::string& to, const std::string& where) {
  const ZonedTime begin = parse_zoned_time(from, where + ".from"), end = parse_zoned_time(to, where + ".to");
  if (!(end.utc_s > begin.utc_s))
    throw_invalid(where + ".to", "'" + to + "' is not after '" + from + "'", "the end of the period");
  constexpr double kLongestS = 20 * 366 * 86400.0;
  if (end.utc_s - begin.utc_s > kLongestS)
    throw_invalid(where + ".to", "the period is longer than 20 years", "20 years or less");
  return {begin.utc_s, end.utc_s, begin.offset_minutes};
}

RadiationSeries radiation_series(const Place& place, const TimeSpan& period, const RadiationTable& table,
                                 int step_minutes, const RunControl& control) {
  SUNFLECK_EXPECTS(step_minutes >= 1 && 60 % step_minutes == 0 && period.end_s > period.begin_s);
  const std::vector<RadiationBlock> blocks = blocks_of(table, period);
  const SunTrack track(blocks.front().begin_s, blocks.back().end_s, control);
  RadiationSeries series;
  series.place = place;
  series.period = period;
  double global_j_m2 = 0, extraterrestrial_j_m2 = 0;
  for (const RadiationBlock& block : blocks) {
    control.check();
    const BlockSun sun = sun_over(block, place, track, 60.0 * step_minutes);
    check_not_too_much(block, sun, table);
    global_j_m2 += block.global_j_m2;
    extraterrestrial_j_m2 += sun.extraterrestrial_j_m2;
    append_steps(block, sun, energies_of(block, sun, table, place), series);
  }
  const double days = (blocks.back().end_s - blocks.front().begin_s) / 86400.0;
  check_not_too_little(global_j_m2, extraterrestrial_j_m2, days, table);
  return series;
}

}  // namespace sunfleck
