// The [stand_light] table of a scene file, key by key.
#include "lighting/study/stand_study.h"
#include "sim/base/error.h"
#include "sim/config/config_table.h"

namespace sunfleck {
namespace {

template <class T>
T named(const ConfigTable& table, const char* key, const char* fallback,
        const std::vector<std::pair<std::string, T>>& values) {
  std::vector<std::string> names;
  for (const auto& [name, value] : values) names.push_back(name);
  const std::string chosen = table.choice_or(key, fallback, names);
  for (const auto& [name, value] : values)
    if (name == chosen) return value;
  return values.front().second;
}

Place read_place(const ConfigTable& table) {
  Place place{table.number("latitude_deg", {-90, 90}), table.number("longitude_deg", {-180, 180})};
  place.elevation_m = table.number_or("elevation_m", 0, {-500, 9000});
  place.pressure_hpa = table.number_or("pressure_hpa", place.pressure_hpa, {0, 1100});
  place.temperature_c = table.number_or("temperature_c", place.temperature_c, {-90, 60});
  return place;
}

OpticsRequest read_bands(const ConfigTable& table) {
  OpticsRequest optics;
  for (const ConfigTable& band : table.tables("bands")) {
    optics.bands.push_back(band.text("name"));
    optics.soil_albedo.push_back(band.number_or("soil_albedo", 0.1, {0, 1}));
  }
  if (optics.bands.empty()) optics = {{"PAR"}, {0.1}, {}};
  return optics;
}

void read_map(const ConfigTable& table, StandStudySpec& spec) {
  spec.ground_cell_m = table.number_or("ground_cell_m", spec.ground_cell_m, {0.01, 1e4});
  const auto map = table.table_if("map");
  if (!map) return;
  spec.map_lo_m = Vec2(map->number("x_from_m", {-1e7, 1e7}), map->number("y_from_m", {-1e7, 1e7}));
  spec.map_hi_m = Vec2(map->number("x_to_m", {-1e7, 1e7}), map->number("y_to_m", {-1e7, 1e7}));
}

void read_cost(const ConfigTable& table, StandStudySpec& spec) {
  spec.rays_per_cell = table.number_or("rays_per_cell", spec.rays_per_cell, {1, 1e7});
  spec.tree_relative_error = table.number_or("tree_relative_error", spec.tree_relative_error, {0, 1});
  spec.sensor_sun_rays =
      static_cast<int>(table.integer_or("sensor_sun_rays", spec.sensor_sun_rays, {1, 1e5}));
  spec.sensor_sky_rays =
      static_cast<int>(table.integer_or("sensor_sky_rays", spec.sensor_sky_rays, {1, 1e5}));
  spec.patch_deg = table.number_or("patch_deg", spec.patch_deg, {1, 30});
  spec.bin_deg = table.number_or("bin_deg", spec.bin_deg, {1, 30});
  spec.seed = static_cast<std::uint64_t>(table.integer_or("seed", 1, {0, 9e15}));
}

}  // namespace

StandStudySpec read_stand_study(const ConfigTable& table) {
  StandStudySpec spec;
  spec.place = read_place(table);
  spec.period = parse_period(table.text("from"), table.text("to"), "stand_light");
  spec.radiation = table.directory() / table.text("radiation");
  spec.sky = named<SkyModel>(table, "sky", "standard_overcast",
                             {{"standard_overcast", SkyModel::kStandardOvercast},
                              {"uniform", SkyModel::kUniform},
                              {"perez", SkyModel::kPerez}});
  spec.intervals = named<IntervalKind>(table, "intervals", "month",
                                       {{"month", IntervalKind::kMonth},
                                        {"period", IntervalKind::kPeriod},
                                        {"day", IntervalKind::kDay},
                                        {"hour", IntervalKind::kHour}});
  spec.engine = named<StandEngine>(
      table, "engine", "auto",
      {{"auto", StandEngine::kAuto}, {"rays", StandEngine::kRays}, {"boxes", StandEngine::kBoxes}});
  if (table.has("sensors")) spec.sensors = read_sensors(table.directory() / table.text("sensors"));
  spec.optics = read_bands(table);
  spec.par.par_fraction = table.number_or("par_fraction", spec.par.par_fraction, {0, 1});
  spec.par.umol_per_j = table.number_or("umol_per_j", spec.par.umol_per_j, {1, 10});
  read_map(table, spec);
  spec.layer_m = table.number_or("layer_m", spec.layer_m, {0.01, 1e3});
  spec.scattering = table.boolean_or("scattering", spec.scattering);
  spec.canopy_views = table.boolean_or("canopy_views", spec.canopy_views);
  read_cost(table, spec);
  return spec;
}

}  // namespace sunfleck
