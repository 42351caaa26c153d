// A place, a period and a radiation table become sun and sky radiation minute by minute.
//
// The energy of a row (month, day, hour) is split into direct and diffuse by the table's share or by
// correlation, and spread over steps of a few minutes: a month over its days by extraterrestrial radiation, a
// day by Collares-Pereira and Rabl (global) and Liu and Jordan (diffuse), an hour by extraterrestrial
// radiation (radiation_split.h). The sum over a row's steps is the row's energy to rounding. Beam on a plane
// facing the sun is direct horizontal / sin(elevation), at most what measurements show (Long and Dutton
// 2002); what is over goes to the diffuse part and is told. A month's table makes every day of the month
// alike: totals by direction are right on average, a single day's weather is not in it.
#pragma once

#include <string>
#include <vector>

#include "lighting/sky/radiation_table.h"
#include "lighting/sky/sun_position.h"

namespace sunfleck {

// [begin, end) of a local clock.
struct TimeSpan {
  double begin_s = 0, end_s = 0;  // seconds since 2000-01-01T00:00 UTC
  int offset_minutes = 0;         // whose days and months count: that of `from`
};
// Throws Error(kInvalidInput) at "<where>.from" or "<where>.to": no time, no time zone, `to` not after
// `from`, more than 20 years.
TimeSpan parse_period(const std::string& from, const std::string& to, const std::string& where);

// Radiation of one step. Energies are of the step's part within the period.
struct SunStep {
  double middle_s = 0, duration_s = 0;
  Vec3 to_sun{0, 0, 1};         // apparent; below the horizon in twilight, then beam is 0
  double beam_normal_j_m2 = 0;  // on a plane that faces the sun
  double diffuse_horizontal_j_m2 = 0;
  double extraterrestrial_normal_w_m2 = 0;
};

struct RadiationSeries {
  Place place;
  TimeSpan period;
  std::vector<SunStep> steps;  // in the order of time; those without energy are left out
  double direct_horizontal_j_m2 = 0, diffuse_horizontal_j_m2 = 0;  // of the period
  double moved_to_diffuse_j_m2 = 0;             // of it: beam beyond what measurements show
  double energy_split_by_correlation_j_m2 = 0;  // of direct + diffuse: rows without a diffuse share
};

// `step_minutes` divides 60 (10: the sun moves 2.5 degrees). Throws Error(kInvalidInput): a month, day or
// hour of the period that the table lacks; a row of more than what arrives outside the atmosphere (months,
// days) or more than is physically possible (hours; also what a wrong time zone gives at night); a table that
// adds up to less than any climate (wrong unit). The message names the unit that would fit. kCancelled.
RadiationSeries radiation_series(const Place& place, const TimeSpan& period, const RadiationTable& table,
                                 int step_minutes = 10, const RunControl& control = {});

}  // namespace sunfleck
