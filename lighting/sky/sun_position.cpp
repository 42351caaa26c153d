#include "lighting/sky/sun_position.h"

#include <libnova/nutation.h>
#include <libnova/solar.h>

#include <cmath>
#include <initializer_list>
#include <mutex>

#include "sim/base/contract.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

// Place of the sun from the Earth's centre, and what apparent sidereal time has beyond the mean.
struct Geocentric {
  double right_ascension_rad, declination_rad, distance_au, equation_of_equinoxes_deg;
};

// Days since 2000-01-01T12:00.
double days_since_j2000(double utc_s) { return utc_s / 86400.0 - 0.5; }

// Terrestrial minus universal time. Espenak and Meeus 2006 (NASA/TP-2006-214141), polynomial expressions for
// delta T; libnova's own table ends in 2007 and leaves 0 after it (0.0008 degrees).
double delta_t_s(double utc_s) {
  const double year = 2000.0 + days_since_j2000(utc_s) / 365.25;
  const auto polynomial = [](double t, std::initializer_list<double> falling) {
    double sum = 0;
    for (const double c : falling) sum = sum * t + c;
    return sum;
  };
  if (year < 1920) return polynomial(year - 1900, {-0.000197, 0.0061966, -0.0598939, 1.494119, -2.79});
  if (year < 1941) return polynomial(year - 1920, {0.0020936, -0.076100, 0.84493, 21.20});
  if (year < 1961) return polynomial(year - 1950, {1.0 / 2547, -1.0 / 233, 0.407, 29.07});
  if (year < 1986) return polynomial(year - 1975, {-1.0 / 718, -1.0 / 260, 1.067, 45.45});
  if (year < 2005)
    return polynomial(year - 2000, {0.00002373599, 0.000651814, 0.0017275, -0.060374, 0.3345, 63.86});
  if (year < 2050) return polynomial(year - 2000, {0.005589, 0.32217, 62.92});
  return -20 + 32 * std::pow((year - 1820) / 100, 2) - 0.5628 * (2150 - year);
}

struct Ephemeris {
  ln_helio_posn geometric{};
  ln_nutation nutation{};
};

// libnova keeps what it answered last in static variables: one thread at a time may ask, and nutation is
// asked for another year first, because one up to 0.1 days old would be given again and the answer depend on
// the call before.
Ephemeris ephemeris(double ephemeris_day) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  Ephemeris e;
  ln_get_solar_geom_coords(ephemeris_day, &e.geometric);
  ln_get_nutation(ephemeris_day - 1000, &e.nutation);
  ln_get_nutation(ephemeris_day, &e.nutation);
  return e;
}

// [SPA] sec. 3.3 - 3.9.
Geocentric geocentric_sun(double utc_s) {
  const double ephemeris_day = 2451545.0 + days_since_j2000(utc_s + delta_t_s(utc_s));
  const auto [geometric, nutation] = ephemeris(ephemeris_day);
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
  return {right_ascension, declination, geometric.R, nutation.longitude * std::cos(obliquity)};
}

// Apparent sidereal time at Greenwich. [SPA] sec. 3.8.
double sidereal_deg(double utc_s, double equation_of_equinoxes_deg) {
  const double days = days_since_j2000(utc_s), centuries = days / 36525.0;
  const double mean =
      280.46061837 + 360.98564736629 * days + centuries * centuries * (0.000387933 - centuries / 38710000.0);
  return std::fmod(mean + equation_of_equinoxes_deg, 360.0);
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

SunPosition seen_from(const Place& place, double utc_s, const Geocentric& sun) {
  const double hour_angle =
      radians_from_degrees(sidereal_deg(utc_s, sun.equation_of_equinoxes_deg) + place.longitude_deg) -
      sun.right_ascension_rad;
  const Topocentric topo = with_parallax(place, sun.declination_rad, hour_angle, sun.distance_au);

  const double latitude = radians_from_degrees(place.latitude_deg);
  const double sin_latitude = std::sin(latitude), cos_latitude = std::cos(latitude);
  const double sin_declination = std::sin(topo.declination_rad),
               cos_declination = std::cos(topo.declination_rad);
  const double cos_hour = std::cos(topo.hour_angle_rad);
  const Vec3 east_north_up(-cos_declination * std::sin(topo.hour_angle_rad),
                           sin_declination * cos_latitude - cos_declination * cos_hour * sin_latitude,
                           sin_declination * sin_latitude + cos_declination * cos_hour * cos_latitude);
  SunPosition seen;
  seen.true_zenith_rad = zenith_of(east_north_up);
  const double elevation_deg = 90.0 - degrees_from_radians(seen.true_zenith_rad);
  seen.zenith_rad = radians_from_degrees(90.0 - elevation_deg - refraction_deg(place, elevation_deg));
  seen.azimuth_rad = azimuth_of(east_north_up);
  seen.hour_angle_rad = std::remainder(topo.hour_angle_rad, 2.0 * kPi);
  seen.declination_rad = topo.declination_rad;
  seen.distance_au = sun.distance_au;
  return seen;
}

}  // namespace

void check_place(const Place& place, const std::string& where) {
  const auto check = [&](const char* name, double value, double lo, double hi) {
    if (!(value >= lo && value <= hi))
      throw_invalid(where + "." + name, "is outside its range",
                    "a number from " + std::to_string(static_cast<int>(lo)) + " to " +
                        std::to_string(static_cast<int>(hi)));
  };
  check("latitude_deg", place.latitude_deg, -90, 90);
  check("longitude_deg", place.longitude_deg, -180, 180);
  check("elevation_m", place.elevation_m, -500, 9000);
  check("pressure_hpa", place.pressure_hpa, 0, 1100);
  check("temperature_c", place.temperature_c, -90, 60);
}

SunPosition sun_position(const Place& place, double utc_s) {
  return seen_from(place, utc_s, geocentric_sun(utc_s));
}

SunPosition sun_position(const Place& place, const UtcTime& time) {
  return sun_position(place, seconds_since_2000(time));
}

// Nodes from one day before `begin` to two days after `end`, so that every moment has two on either side.
SunTrack::SunTrack(double begin_utc_s, double end_utc_s, const RunControl& control)
    : first_day_(std::floor(begin_utc_s / 86400.0) - 1.0) {
  const auto count = static_cast<std::size_t>(std::floor(end_utc_s / 86400.0) - first_day_) + 3;
  nodes_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    control.check();
    const Geocentric sun = geocentric_sun((first_day_ + static_cast<double>(i)) * 86400.0);
    double right_ascension = sun.right_ascension_rad;
    if (i > 0) {
      const double before = nodes_.back().right_ascension_rad;
      right_ascension = before + std::remainder(right_ascension - before, 2.0 * kPi);
    }
    nodes_.push_back({right_ascension, sun.declination_rad, sun.distance_au, sun.equation_of_equinoxes_deg});
  }
}

SunPosition SunTrack::at(const Place& place, double utc_s) const {
  const double day = utc_s / 86400.0 - first_day_;
  SUNFLECK_EXPECTS(day >= 1.0 && day < static_cast<double>(nodes_.size()) - 2.0);
  const auto i = static_cast<std::size_t>(day);
  // Lagrange's cubic through four days, the moment between the two in the middle.
  const double x = day - static_cast<double>(i);
  const double weight[4] = {-x * (x - 1) * (x - 2) / 6, (x + 1) * (x - 1) * (x - 2) / 2,
                            -(x + 1) * x * (x - 2) / 2, (x + 1) * x * (x - 1) / 6};
  Geocentric sun{0, 0, 0, 0};
  for (std::size_t k = 0; k < 4; ++k) {
    const Node& node = nodes_[i - 1 + k];
    sun.right_ascension_rad += weight[k] * node.right_ascension_rad;
    sun.declination_rad += weight[k] * node.declination_rad;
    sun.distance_au += weight[k] * node.distance_au;
    sun.equation_of_equinoxes_deg += weight[k] * node.equation_of_equinoxes_deg;
  }
  return seen_from(place, utc_s, sun);
}

}  // namespace sunfleck
