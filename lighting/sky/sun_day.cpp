#include "lighting/sky/sun_day.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sunfleck {
namespace {

// The sun's elevation along one day, above the elevation that counts as rise and set.
class DayArc {
 public:
  DayArc(const Place& place, const SunTrack& track, double begin_s)
      : place_(place), track_(track), begin_s_(begin_s) {}

  double height_deg(double utc_s) const {
    return 90.0 - degrees_from_radians(track_.at(place_, utc_s).true_zenith_rad) - kRiseElevationDeg;
  }

  // Largest (sign 1) or smallest (sign -1) height between two moments: golden section.
  double extreme(double lo, double hi, double sign) const {
    constexpr double kShrink = 0.6180339887498949;
    while (hi - lo > 0.5) {
      const double a = hi - kShrink * (hi - lo), b = lo + kShrink * (hi - lo);
      (sign * height_deg(a) < sign * height_deg(b) ? lo : hi) =
          sign * height_deg(a) < sign * height_deg(b) ? a : b;
    }
    return 0.5 * (lo + hi);
  }

  // Where the height passes 0 between two moments of different sign.
  double crossing(double lo, double hi) const {
    const bool up = height_deg(hi) > 0.0;
    while (hi - lo > 0.05) {
      const double middle = 0.5 * (lo + hi);
      ((height_deg(middle) > 0.0) == up ? hi : lo) = middle;
    }
    return 0.5 * (lo + hi);
  }

  double begin_s() const { return begin_s_; }

 private:
  const Place& place_;
  const SunTrack& track_;
  double begin_s_;
};

constexpr int kSamples = 288;  // five minutes
constexpr double kSampleS = 86400.0 / kSamples;

// Moments between which the height rises or falls throughout: the day's ends, its highest and its lowest.
std::array<double, 4> turning_points(const DayArc& arc) {
  std::array<double, kSamples + 1> height{};
  for (int i = 0; i <= kSamples; ++i)
    height[static_cast<std::size_t>(i)] = arc.height_deg(arc.begin_s() + i * kSampleS);
  const double end = arc.begin_s() + 86400.0;
  const auto refined = [&](auto sample, double sign) {
    const double middle = arc.begin_s() + static_cast<double>(sample - height.begin()) * kSampleS;
    return arc.extreme(std::max(arc.begin_s(), middle - kSampleS), std::min(end, middle + kSampleS), sign);
  };
  const double highest = refined(std::max_element(height.begin(), height.end()), 1.0);
  const double lowest = refined(std::min_element(height.begin(), height.end()), -1.0);
  return {arc.begin_s(), std::min(highest, lowest), std::max(highest, lowest), end};
}

void find_rise_and_set(const DayArc& arc, SunDay& day) {
  const std::array<double, 4> turn = turning_points(arc);
  day.noon_utc_s = arc.height_deg(turn[1]) > arc.height_deg(turn[2]) ? turn[1] : turn[2];
  for (std::size_t i = 0; i + 1 < turn.size(); ++i) {
    const bool up_before = arc.height_deg(turn[i]) > 0.0, up_after = arc.height_deg(turn[i + 1]) > 0.0;
    if (up_before == up_after) {
      day.day_length_s += up_before ? turn[i + 1] - turn[i] : 0.0;
      continue;
    }
    const double crossing = arc.crossing(turn[i], turn[i + 1]);
    day.day_length_s += up_after ? turn[i + 1] - crossing : crossing - turn[i];
    std::optional<double>& event = up_after ? day.sunrise_utc_s : day.sunset_utc_s;
    if (!event) event = crossing;
  }
}

}  // namespace

double extraterrestrial_normal_w_m2(const SunPosition& sun) {
  return kSolarConstantWM2 / (sun.distance_au * sun.distance_au);
}

double extraterrestrial_horizontal_w_m2(const SunPosition& sun) {
  return extraterrestrial_normal_w_m2(sun) * std::max(0.0, std::cos(sun.true_zenith_rad));
}

SunDay sun_day(const Place& place, const SunTrack& track, int day, int offset_minutes) {
  const DayArc arc(place, track, day_begin_s(day, offset_minutes));
  SunDay result;
  find_rise_and_set(arc, result);
  for (int i = 0; i < kSamples; ++i)
    result.extraterrestrial_j_m2 +=
        kSampleS * extraterrestrial_horizontal_w_m2(track.at(place, arc.begin_s() + (i + 0.5) * kSampleS));
  return result;
}

SunDay sun_day(const Place& place, const CivilDate& date, int offset_minutes) {
  const int day = day_number(date);
  const double begin_s = day_begin_s(day, offset_minutes);
  return sun_day(place, SunTrack(begin_s, begin_s + 86400.0), day, offset_minutes);
}

}  // namespace sunfleck
