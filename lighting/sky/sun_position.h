// Where the sun stands, by place and time. Ephemeris (VSOP87, nutation, aberration, sidereal time) from
// libnova; parallax and refraction as in Reda and Andreas 2004 (NREL/TP-560-34302), sec. 3.14. Good to 0.001
// degrees between 1950 and 2050.
#pragma once

#include <string>

#include "sim/base/vec.h"

namespace sunfleck {

struct Place {
  double latitude_deg = 0;   // north positive, [-90, 90]
  double longitude_deg = 0;  // east positive, [-180, 180]
  double elevation_m = 0;
  double pressure_hpa = 1013.25;  // 0 switches refraction off
  double temperature_c = 10;
};

struct UtcTime {
  int year = 2000, month = 1, day = 1, hour = 0, minute = 0;
  double second = 0;
};

// "2024-06-21T11:30:00Z" (seconds and Z may be left out; an offset like +02:00 is understood). Throws
// Error(kInvalidInput) at `where`.
UtcTime parse_utc_time(const std::string& text, const std::string& where);

struct SunPosition {
  double zenith_rad = 0;   // apparent, refraction included
  double azimuth_rad = 0;  // clockwise from north
  Vec3 to_sun() const { return direction_from_azimuth_zenith(azimuth_rad, zenith_rad); }
};
SunPosition sun_position(const Place& place, const UtcTime& time);

}  // namespace sunfleck
