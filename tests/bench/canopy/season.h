// A growing season over a measured stand, from its table of monthly radiation: an hourly sum of sun
// positions, for measurements of stand light on its own.
//
// Every month's global radiation is shared out over its daylight hours in proportion to the extraterrestrial
// radiation on the horizontal (clearness the same all month), and split by the month's diffuse fraction. The
// sun's directions are binned in azimuth and height.
#pragma once

#include <filesystem>

#include "lighting/canopy/light_weights.h"
#include "lighting/sky/illumination.h"
#include "lighting/sky/sun_position.h"

namespace sunfleck::bench {

struct SeasonOptions {
  Place place{.latitude_deg = 50.03617, .longitude_deg = 5.20634, .elevation_m = 400};
  int year = 2011, first_month = 4, last_month = 10;
  double bin_deg = 5;  // sun bins
  int sky_rings = 9;   // equal steps of cos(zenith)
  SkyModel sky = SkyModel::kUniform;
  bool by_month = true;  // else one interval for the season
};

// Energy in MJ m-2; `table` has columns month, global_horizontal_mj_m2, diffuse_fraction.
StandSky season_sky(const std::filesystem::path& table, const SeasonOptions& options);

}  // namespace sunfleck::bench
