// A virtual hemispherical photograph with the ways of the sun across it: at the solstices and the equinoxes,
// a mark at every full hour.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lighting/canopy/sensor_canopy.h"
#include "lighting/sky/sun_position.h"

namespace sunfleck {

// The sun over one day, as long as it is above the horizon.
struct SunPath {
  CivilDate date;
  struct Point {
    Vec2 at{0};  // in the photograph: (0, 0) the zenith, radius 1 the horizon, y to the north, x to the west
                 // (east on the left)
    int hour = -1;  // of the local clock, at full hours; else -1
  };
  std::vector<Point> points;  // every five minutes
};

// Where a direction to the sky lies in the photograph: zenith angle / 90 degrees from the middle.
Vec2 place_in_photograph(double azimuth_rad, double zenith_rad);

// 20 March, 21 June, 22 September and 21 December of that year; days without sun have no points.
// `utc_offset_minutes`: of the clock whose hours are marked.
std::vector<SunPath> sun_paths(const Place& place, int year, int utc_offset_minutes);

// .png of about `pixels` for the photograph and a rim around it with compass, zenith angles and a title.
// Throws Error(kInvalidInput) for another extension, kInputOutput as draw_plots().
void draw_sun_paths(const HemisphericalPhotograph& photograph, const std::vector<SunPath>& paths,
                    const std::string& title, const std::filesystem::path& path);

}  // namespace sunfleck
