// Diffuse share of global radiation where a table does not give it, and how radiation spreads over a day.
// Correlations of long records from a few stations: a single hour may be wrong by 0.2, a month by 0.05.
#pragma once

namespace sunfleck {

// Diffuse / global on the horizontal, from the clearness index (global / extraterrestrial horizontal, clamped
// to [0, 1]). `sunset_hour_angle_rad` is half the day's length as an angle, [0, pi]. [Erbs82] Erbs, Klein and
// Duffie 1982, Solar Energy 28:293-302; days and months as in Duffie and Beckman 2013, Solar Engineering of
// Thermal Processes, Eq. 2.11.1 and 2.12.1.
double hourly_diffuse_fraction(double clearness_index);
double daily_diffuse_fraction(double clearness_index, double sunset_hour_angle_rad);
// Fitted for indexes in [0.3, 0.8] and held constant outside.
double monthly_diffuse_fraction(double clearness_index, double sunset_hour_angle_rad);

// Global radiation at an hour angle relative to extraterrestrial horizontal radiation, up to a factor of the
// day: a + b cos(hour angle). Collares-Pereira and Rabl 1979, Solar Energy 22:155-164. Diffuse radiation
// follows extraterrestrial radiation itself: Liu and Jordan 1960, Solar Energy 4:1-19.
double hourly_global_shape(double hour_angle_rad, double sunset_hour_angle_rad);

// Most beam radiation on a plane facing the sun that measurements show. Long and Dutton 2002, BSRN Global
// Network recommended QC tests, "extremely rare" limit: 0.95 S mu^0.2 + 10 W m-2.
double most_beam_normal_w_m2(double extraterrestrial_normal_w_m2, double cos_zenith);
// Most global radiation, same source, "physically possible": 1.5 S mu^1.2 + 100 W m-2.
double most_global_horizontal_w_m2(double extraterrestrial_normal_w_m2, double cos_zenith);

// Sunset hour angle of a day from the sun's declination, [0, pi]: 0 in polar night, pi where it does not set.
double sunset_hour_angle_rad(double latitude_rad, double declination_rad);

}  // namespace sunfleck
