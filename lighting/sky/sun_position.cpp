#include "lighting/sky/sun_position.h"

#include <libnova/dynamical_time.h>
#include <libnova/julian_day.h>
#include <libnova/nutation.h>
#include <libnova/solar.h>

#include <cmath>
#include <cstdio>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

struct Geocentric {
  double right_ascension_rad, declination_rad, distance_au, sidereal_deg;
};

// Apparent place of the sun from the Earth's centre, and apparent sidereal time at Greenwich. [SPA] sec. 3.3
// - 3.10.
Geocentric geocentric_sun(double julian_day) {
  const double ephemeris_day = ln_get_jde(julian_day);
  ln_helio_posn geometric{};
  ln_get_solar_geom_coords(ephemeris_day, &geometric);
  ln_nutation nutation{};
  ln_get_nutation(ephemeris_day, &nutation);
  const double obliquity = radians_from_degrees(nutation.ecliptic + nutation.obliquity);
  const double aberration_deg = -20.4898 / 3600.0 / geometric.R;
  // libnova's place refers to ecliptic and equinox of J2000: precession brings it to those of date (Meeus
  // 1998, Astronomical Algorithms, Eq. 21.5 - 21.7 to first order in the turn of the ecliptic).
  const double t = (ephemeris_day - 2451545.0) / 36525.0;
  const double precession_deg = t * (5029.0966 + 1.1111 * t) / 3600.0;
  const double longitude =
      radians_from_degrees(geometric.L + precession_deg + nutation.longitude + aberration_deg);
  const double tilt_deg = 47.0029 / 3600.0 * t;
  const double latitude =
      radians_from_degrees(geometric.B - tilt_deg * std::sin(radians_from_degrees(geometric.L - 174.8764)));
  const double declination = std::asin(std::sin(latitude) * std::cos(obliquity) +
                                       std::cos(latitude) * std::sin(obliquity) * std::sin(longitude));
  const double right_ascension =
      std::atan2(std::sin(longitude) * std::cos(obliquity) - std::tan(latitude) * std::sin(obliquity),
                 std::cos(longitude));
  const double days = julian_day - 2451545.0, centuries = days / 36525.0;
  const double mean_sidereal_deg =
      280.46061837 + 360.98564736629 * days + centuries * centuries * (0.000387933 - centuries / 38710000.0);
  return {right_ascension, declination, geometric.R,
          std::fmod(mean_sidereal_deg + nutation.longitude * std::cos(obliquity), 360.0)};
}

// Sun as seen from the place instead of the centre of the Earth. [SPA] sec. 3.12.
struct Topocentric {
  double declination_rad, hour_angle_rad;
};

Topocentric with_parallax(const Place& place, double declination_rad, double hour_angle_rad,
                          double distance_au) {
  const double latitude = radians_from_degrees(place.latitude_deg);
  const double parallax = radians_from_degrees(8.794 / 3600.0 / distance_au);
  const double u = std::atan(0.99664719 * std::tan(latitude));
  const double x = std::cos(u) + place.elevation_m / 6378140.0 * std::cos(latitude);
  const double y = 0.99664719 * std::sin(u) + place.elevation_m / 6378140.0 * std::sin(latitude);
  const double below = std::cos(declination_rad) - x * std::sin(parallax) * std::cos(hour_angle_rad);
  const double shift = std::atan2(-x * std::sin(parallax) * std::sin(hour_angle_rad), below);
  const double declination =
      std::atan2((std::sin(declination_rad) - y * std::sin(parallax)) * std::cos(shift), below);
  return {declination, hour_angle_rad - shift};
}

// Lift of a true elevation by the atmosphere, degrees. [SPA] Eq. 42; none well below the horizon.
double refraction_deg(const Place& place, double elevation_deg) {
  if (elevation_deg < -0.8333 || place.pressure_hpa <= 0.0) return 0.0;
  return place.pressure_hpa / 1010.0 * 283.0 / (273.0 + place.temperature_c) * 1.02 /
         (60.0 * std::tan(radians_from_degrees(elevation_deg + 10.3 / (elevation_deg + 5.11))));
}

bool valid(const UtcTime& t) {
  return t.year >= 1900 && t.year <= 2100 && t.month >= 1 && t.month <= 12 && t.day >= 1 && t.day <= 31 &&
         t.hour >= -24 && t.hour <= 48 && t.minute >= -60 && t.minute <= 119 && t.second >= 0.0 &&
         t.second < 61.0;
}

}  // namespace

UtcTime parse_utc_time(const std::string& text, const std::string& where) {
  UtcTime t;
  int used = 0;
  const int fields = std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d%n", &t.year, &t.month, &t.day, &t.hour,
                                 &t.minute, &used);
  std::string rest = fields == 5 ? text.substr(static_cast<std::size_t>(used)) : "?";
  if (!rest.empty() && rest[0] == ':') {
    int length = 0;
    rest = std::sscanf(rest.c_str(), ":%lf%n", &t.second, &length) == 1
               ? rest.substr(static_cast<std::size_t>(length))
               : "?";
  }
  const bool in_range = t.hour >= 0 && t.hour <= 24 && t.minute >= 0 && t.minute < 60;
  int offset_hour = 0, offset_minute = 0;
  if (rest.size() == 6 && (rest[0] == '+' || rest[0] == '-') &&
      std::sscanf(rest.c_str() + 1, "%2d:%2d", &offset_hour, &offset_minute) == 2) {
    const int sign = rest[0] == '+' ? 1 : -1;
    t.hour -= sign * offset_hour;
    t.minute -= sign * offset_minute;
    rest.clear();
  }
  if (!in_range || (rest != "" && rest != "Z") || !valid(t))
    throw_invalid(where, "'" + text + "' is not a time between 1900 and 2100",
                  "for example 2024-06-21T11:30:00Z");
  return t;
}

SunPosition sun_position(const Place& place, const UtcTime& time) {
  ln_date date{};
  date.years = time.year;
  date.months = time.month;
  date.days = time.day;
  // Hours and minutes may run over a day's end after an offset: add them as a fraction of a day.
  const double julian_day =
      ln_get_julian_day(&date) + (time.hour + (time.minute + time.second / 60.0) / 60.0) / 24.0;
  const Geocentric sun = geocentric_sun(julian_day);
  const double hour_angle =
      radians_from_degrees(sun.sidereal_deg + place.longitude_deg) - sun.right_ascension_rad;
  const Topocentric topo = with_parallax(place, sun.declination_rad, hour_angle, sun.distance_au);

  const double latitude = radians_from_degrees(place.latitude_deg);
  const Vec3 east_north_up(
      -std::cos(topo.declination_rad) * std::sin(topo.hour_angle_rad),
      std::sin(topo.declination_rad) * std::cos(latitude) -
          std::cos(topo.declination_rad) * std::cos(topo.hour_angle_rad) * std::sin(latitude),
      std::sin(topo.declination_rad) * std::sin(latitude) +
          std::cos(topo.declination_rad) * std::cos(topo.hour_angle_rad) * std::cos(latitude));
  const double elevation_deg = 90.0 - degrees_from_radians(zenith_of(east_north_up));
  return {radians_from_degrees(90.0 - elevation_deg - refraction_deg(place, elevation_deg)),
          azimuth_of(east_north_up)};
}

}  // namespace sunfleck
