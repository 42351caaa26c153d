// What the sun does on one day of the local clock: rise, set, day length, and how much radiation there would
// be without an atmosphere. A day the sun does not rise (polar night) has length and radiation 0 and no
// sunrise; a day it does not set has 86,400 s; neither is an error.
#pragma once

#include <optional>

#include "lighting/sky/sun_position.h"

namespace sunfleck {

// At the mean distance of the sun. Gueymard 2018, Solar Energy 168:2-7.
inline constexpr double kSolarConstantWM2 = 1361.1;
// True elevation of the sun's centre when its upper edge appears at the horizon: 34' of refraction and 16' of
// radius. [SPA] A.2.
inline constexpr double kRiseElevationDeg = -0.8333;

// Extraterrestrial radiation at a position of the sun, on a plane that faces it and on a horizontal plane (by
// the true zenith angle; 0 below the horizon).
double extraterrestrial_normal_w_m2(const SunPosition& sun);
double extraterrestrial_horizontal_w_m2(const SunPosition& sun);

struct SunDay {
  std::optional<double> sunrise_utc_s, sunset_utc_s;  // first of the day, if there is one
  double noon_utc_s = 0;                              // the sun at its highest
  double day_length_s = 0;                            // time from rise to set, of this day
  double extraterrestrial_j_m2 = 0;                   // on a horizontal plane
};

// `day` counts from 2000-01-01 = 0 (utc_time.h) and lasts from local midnight to local midnight; `track` must
// reach over it. Rise and set to 0.1 s, the integral to 0.01 %.
SunDay sun_day(const Place& place, const SunTrack& track, int day, int offset_minutes);
SunDay sun_day(const Place& place, const CivilDate& date, int offset_minutes);

}  // namespace sunfleck
