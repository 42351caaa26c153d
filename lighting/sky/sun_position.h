// Where the sun stands, by place and time. Ephemeris (VSOP87, nutation, aberration, sidereal time) from
// libnova; parallax and refraction as in Reda and Andreas 2004 (NREL/TP-560-34302, [SPA]), sec. 3.12 - 3.14.
// Good to 0.0005 degrees between 1950 and 2050 where refraction is small; what refraction really is near the
// horizon varies by 0.1 degrees with the weather.
#pragma once

#include <vector>

#include "lighting/sky/utc_time.h"
#include "sim/base/run_control.h"
#include "sim/base/vec.h"

namespace sunfleck {

struct Place {
  double latitude_deg = 0;   // north positive, [-90, 90]
  double longitude_deg = 0;  // east positive, [-180, 180]
  double elevation_m = 0;
  double pressure_hpa = 1013.25;  // 0 switches refraction off
  double temperature_c = 10;
};

// Throws Error(kInvalidInput) naming "<where>.latitude_deg" and so on: not finite, or outside its range
// (elevation [-500, 9000] m, pressure [0, 1100] hPa, temperature [-90, 60] C).
void check_place(const Place& place, const std::string& where);

struct SunPosition {
  double zenith_rad = 0;       // apparent, refraction included
  double azimuth_rad = 0;      // clockwise from north
  double true_zenith_rad = 0;  // without refraction
  double hour_angle_rad = 0;   // west positive, (-pi, pi]; 0 when the sun passes the meridian
  double declination_rad = 0;  // seen from the place
  double distance_au = 1;
  Vec3 to_sun() const { return direction_from_azimuth_zenith(azimuth_rad, zenith_rad); }
};
SunPosition sun_position(const Place& place, const UtcTime& time);
SunPosition sun_position(const Place& place, double utc_s);  // seconds since 2000-01-01T00:00 UTC

// The same for very many moments: the ephemeris once a day, between them by cubics. Differs from sun_position
// by less than 1e-5 degrees and costs a hundredth. Read-only once made, so threads may share it.
class SunTrack {
 public:
  // 40 us per day. Throws Error(kCancelled) when stopped.
  SunTrack(double begin_utc_s, double end_utc_s, const RunControl& control = {});
  SunPosition at(const Place& place, double utc_s) const;  // begin <= utc_s <= end

 private:
  struct Node {
    double right_ascension_rad, declination_rad, distance_au, equation_of_equinoxes_deg;
  };
  double first_day_;
  std::vector<Node> nodes_;  // one a day; right ascension without jumps
};

}  // namespace sunfleck
