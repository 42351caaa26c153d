// Head comment in stand_request.h: from the wire. Ranges are those of the [stand_light] table of scene files.
#include "server/convert/stand_request.h"

#include <cmath>
#include <set>

#include "server/convert/light_spec_message.h"
#include "sunfleck/v1/light.pb.h"
#include "sunfleck/v1/stand_light.pb.h"

namespace sunfleck {
namespace {

constexpr double kFarthest_m = 1e7;

Place place_from_message(const v1::Place& message, const std::string& field, Violations& violations) {
  Place place{message.latitude_deg(), message.longitude_deg()};
  place.elevation_m = message.elevation_m();
  if (message.has_pressure_hpa()) place.pressure_hpa = message.pressure_hpa();
  if (message.has_temperature_c()) place.temperature_c = message.temperature_c();
  violations.number(field + ".latitude_deg", place.latitude_deg, -90, 90);
  violations.number(field + ".longitude_deg", place.longitude_deg, -180, 180);
  violations.number(field + ".elevation_m", place.elevation_m, -500, 9000);
  violations.number(field + ".pressure_hpa", place.pressure_hpa, 0, 1100);
  violations.number(field + ".temperature_c", place.temperature_c, -90, 60);
  return place;
}

SkyModel sky_from_message(v1::SkyModel sky, const std::string& field, Violations& violations) {
  switch (sky) {
    case v1::SKY_MODEL_UNSPECIFIED:
    case v1::SKY_MODEL_STANDARD_OVERCAST:
      return SkyModel::kStandardOvercast;
    case v1::SKY_MODEL_UNIFORM:
      return SkyModel::kUniform;
    case v1::SKY_MODEL_PEREZ:
      return SkyModel::kPerez;
    default:
      break;
  }
  violations.add(field, "unknown sky model " + std::to_string(sky));
  return SkyModel::kStandardOvercast;
}

IntervalKind intervals_from_message(v1::IntervalKind kind, const std::string& field, Violations& violations) {
  switch (kind) {
    case v1::INTERVAL_KIND_UNSPECIFIED:
    case v1::INTERVAL_KIND_MONTH:
      return IntervalKind::kMonth;
    case v1::INTERVAL_KIND_PERIOD:
      return IntervalKind::kPeriod;
    case v1::INTERVAL_KIND_DAY:
      return IntervalKind::kDay;
    case v1::INTERVAL_KIND_HOUR:
      return IntervalKind::kHour;
    default:
      break;
  }
  violations.add(field, "unknown kind of interval " + std::to_string(kind));
  return IntervalKind::kMonth;
}

StandEngine engine_from_message(v1::StandEngine engine, const std::string& field, Violations& violations) {
  switch (engine) {
    case v1::STAND_ENGINE_UNSPECIFIED:
    case v1::STAND_ENGINE_AUTO:
      return StandEngine::kAuto;
    case v1::STAND_ENGINE_RAYS:
      return StandEngine::kRays;
    case v1::STAND_ENGINE_BOXES:
      return StandEngine::kBoxes;
    default:
      break;
  }
  violations.add(field, "unknown engine " + std::to_string(engine));
  return StandEngine::kAuto;
}

void read_times(const v1::StandLightSpec& message, const std::string& field, const Limits& limits,
                Violations& violations, StandStudySpec& spec) {
  spec.intervals = intervals_from_message(message.intervals(), field + ".intervals", violations);
  try {
    spec.period = parse_period(message.period().from(), message.period().to(), field + ".period");
  } catch (const Error& error) {
    return violations.add(error.where(), clipped(error.problem()) + " (" + error.remedy() + ")");
  }
  const std::size_t count = interval_count(spec.period, spec.intervals);
  if (count > limits.stand_intervals)
    violations.add(field + ".intervals", "must make at most " + std::to_string(limits.stand_intervals) +
                                             " intervals, got " + std::to_string(count));
}

std::optional<double> read_share(bool given, double value, const std::string& field, Violations& violations) {
  if (!given) return std::nullopt;
  if (value > 1 && value <= 100)
    violations.add(field, "looks like percent, must be a share in [0, 1]");
  else
    violations.number(field, value, 0, 1);
  return value;
}

Vec3 read_normal(const v1::StandSensor& message, const std::string& field, Violations& violations) {
  if (!message.has_normal()) return {0, 0, 1};
  const Vec3 normal(message.normal().x(), message.normal().y(), message.normal().z());
  const double length = glm::length(normal);
  if (!is_finite(normal) || !(length > 1e-12) || !(length < 1e12))
    violations.add(field, "must be a finite direction of a length in (1e-12, 1e12)");
  return normal;
}

SensorRow read_sensor(const v1::StandSensor& message, const std::string& field, Violations& violations) {
  SensorRow row;
  row.sensor.name = message.name();
  if (!message.name().empty()) violations.text(field + ".name", message.name(), 200);
  row.sensor.position_m = {message.x_m(), message.y_m()};
  violations.number(field + ".x_m", message.x_m(), -kFarthest_m, kFarthest_m);
  violations.number(field + ".y_m", message.y_m(), -kFarthest_m, kFarthest_m);
  if (message.has_height_m()) row.sensor.height_m = message.height_m();
  violations.number(field + ".height_m", row.sensor.height_m, 1e-3, 200);
  row.sensor.normal = read_normal(message, field + ".normal", violations);
  row.pacl = read_share(message.has_pacl(), message.pacl(), field + ".pacl", violations);
  row.pacl_direct =
      read_share(message.has_pacl_direct(), message.pacl_direct(), field + ".pacl_direct", violations);
  row.pacl_diffuse =
      read_share(message.has_pacl_diffuse(), message.pacl_diffuse(), field + ".pacl_diffuse", violations);
  return row;
}

void read_sensors(const v1::StandLightSpec& message, const std::string& field, const Limits& limits,
                  Violations& violations, StandStudySpec& spec) {
  const auto count = static_cast<std::size_t>(message.sensors_size());
  if (!violations.count(field, count, 0, limits.stand_sensors)) return;
  std::set<std::string> names;
  for (int i = 0; i < message.sensors_size(); ++i) {
    const std::string place = at(field, static_cast<std::size_t>(i));
    spec.sensors.push_back(read_sensor(message.sensors(i), place, violations));
    const std::string& name = message.sensors(i).name();
    if (!name.empty() && !names.insert(name).second)
      violations.add(place + ".name", "must be unique, '" + clipped(name) + "' was there before");
  }
}

void read_bands(const v1::StandLightSpec& message, const std::string& field, const Limits& limits,
                Violations& violations, StandStudySpec& spec) {
  const auto size = [](int n) { return static_cast<std::size_t>(n); };
  spec.optics = {{"PAR"}, {0.1}, {}};
  if (!violations.count(field + ".bands", size(message.bands_size()), 0, limits.bands)) return;
  if (!violations.count(field + ".overrides", size(message.overrides_size()), 0, limits.overrides)) return;
  if (message.bands_size() > 0) spec.optics = {};
  std::set<std::string> names(spec.optics.bands.begin(), spec.optics.bands.end());
  for (int i = 0; i < message.bands_size(); ++i) {
    const v1::StandBand& band = message.bands(i);
    const std::string place = at(field + ".bands", size(i));
    violations.text(place + ".name", band.name(), 64);
    if (!names.insert(band.name()).second)
      violations.add(place + ".name", "must be unique, '" + clipped(band.name()) + "' was there before");
    spec.optics.bands.push_back(band.name());
    spec.optics.soil_albedo.push_back(band.has_soil_albedo() ? band.soil_albedo() : 0.1);
    violations.number(place + ".soil_albedo", spec.optics.soil_albedo.back(), 0, 1);
  }
  for (int i = 0; i < message.overrides_size(); ++i)
    spec.optics.overrides.push_back(
        override_from_message(message.overrides(i), at(field + ".overrides", size(i)), names, violations));
}

void read_map(const v1::StandLightSpec& message, const std::string& field, Violations& violations,
              StandStudySpec& spec) {
  if (message.has_ground_cell_m()) spec.ground_cell_m = message.ground_cell_m();
  if (message.has_layer_m()) spec.layer_m = message.layer_m();
  violations.number(field + ".ground_cell_m", spec.ground_cell_m, 0.01, 1e4);
  violations.number(field + ".layer_m", spec.layer_m, 0.01, 1e3);
  if (message.has_plot_area_m2()) spec.plot_area_m2 = message.plot_area_m2();
  violations.number(field + ".plot_area_m2", spec.plot_area_m2, 0, 1e12);
  if (!message.has_map()) return;
  const v1::MapArea& map = message.map();
  spec.map_lo_m = Vec2(map.x_from_m(), map.y_from_m());
  spec.map_hi_m = Vec2(map.x_to_m(), map.y_to_m());
  bool good = violations.number(field + ".map.x_from_m", map.x_from_m(), -kFarthest_m, kFarthest_m);
  good = violations.number(field + ".map.y_from_m", map.y_from_m(), -kFarthest_m, kFarthest_m) && good;
  good = violations.number(field + ".map.x_to_m", map.x_to_m(), -kFarthest_m, kFarthest_m) && good;
  good = violations.number(field + ".map.y_to_m", map.y_to_m(), -kFarthest_m, kFarthest_m) && good;
  if (good && !(map.x_from_m() < map.x_to_m()))
    violations.add(field + ".map.x_to_m", "must be more than x_from_m");
  if (good && !(map.y_from_m() < map.y_to_m()))
    violations.add(field + ".map.y_to_m", "must be more than y_from_m");
}

void read_cost(const v1::StandLightSpec& message, const std::string& field, Violations& violations,
               StandStudySpec& spec) {
  spec.engine = engine_from_message(message.engine(), field + ".engine", violations);
  if (message.has_scattering()) spec.scattering = message.scattering();
  if (message.has_canopy_views()) spec.canopy_views = message.canopy_views();
  if (message.has_rays_per_cell()) spec.rays_per_cell = message.rays_per_cell();
  if (message.has_tree_relative_error()) spec.tree_relative_error = message.tree_relative_error();
  if (message.has_sensor_sun_rays()) spec.sensor_sun_rays = message.sensor_sun_rays();
  if (message.has_sensor_sky_rays()) spec.sensor_sky_rays = message.sensor_sky_rays();
  if (message.has_patch_deg()) spec.patch_deg = message.patch_deg();
  if (message.has_bin_deg()) spec.bin_deg = message.bin_deg();
  if (message.has_seed()) spec.seed = message.seed();
  violations.number(field + ".rays_per_cell", spec.rays_per_cell, 1, 1e7);
  violations.number(field + ".tree_relative_error", spec.tree_relative_error, 0, 1);
  violations.integer(field + ".sensor_sun_rays", spec.sensor_sun_rays, 1, 100'000);
  violations.integer(field + ".sensor_sky_rays", spec.sensor_sky_rays, 1, 100'000);
  if (message.has_patch_deg()) violations.number(field + ".patch_deg", spec.patch_deg, 1, 30);
  if (message.has_bin_deg()) violations.number(field + ".bin_deg", spec.bin_deg, 1, 30);
}

void read_par(const v1::StandLightSpec& message, const std::string& field, Violations& violations,
              ParFactors& par) {
  if (message.has_par_fraction()) par.par_fraction = message.par_fraction();
  if (message.has_umol_per_j()) par.umol_per_j = message.umol_per_j();
  violations.number(field + ".par_fraction", par.par_fraction, 0, 1);
  violations.number(field + ".umol_per_j", par.umol_per_j, 1, 10);
}

}  // namespace

StandStudySpec stand_spec_from_message(const v1::StandLightSpec& message, const std::string& field,
                                       const Limits& limits, Violations& violations) {
  StandStudySpec spec;
  if (!message.has_place()) violations.add(field + ".place", "must be given");
  spec.place = place_from_message(message.place(), field + ".place", violations);
  read_times(message, field, limits, violations, spec);
  const std::string& name = message.radiation().name();
  if (!name.empty()) violations.text(field + ".radiation.name", name, 200);
  spec.radiation = name;
  spec.radiation_table = radiation_from_message(message.radiation(), field + ".radiation", violations);
  spec.sky = sky_from_message(message.sky(), field + ".sky", violations);
  read_sensors(message, field + ".sensors", limits, violations, spec);
  read_bands(message, field, limits, violations, spec);
  read_par(message, field, violations, spec.par);
  read_map(message, field, violations, spec);
  read_cost(message, field, violations, spec);
  return spec;
}

}  // namespace sunfleck
