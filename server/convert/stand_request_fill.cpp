// Head comment in stand_request.h: to the wire, and messages of lighting at the fields they are about.
#include <algorithm>

#include "lighting/sky/utc_time.h"
#include "server/convert/light_spec_message.h"
#include "server/convert/stand_request.h"
#include "sunfleck/v1/light.pb.h"
#include "sunfleck/v1/stand_light.pb.h"

namespace sunfleck {
namespace {

v1::IntervalKind message_intervals(IntervalKind kind) {
  switch (kind) {
    case IntervalKind::kPeriod:
      return v1::INTERVAL_KIND_PERIOD;
    case IntervalKind::kMonth:
      return v1::INTERVAL_KIND_MONTH;
    case IntervalKind::kDay:
      return v1::INTERVAL_KIND_DAY;
    case IntervalKind::kHour:
      return v1::INTERVAL_KIND_HOUR;
  }
  return v1::INTERVAL_KIND_UNSPECIFIED;
}

v1::StandEngine message_engine(StandEngine engine) {
  switch (engine) {
    case StandEngine::kAuto:
      return v1::STAND_ENGINE_AUTO;
    case StandEngine::kRays:
      return v1::STAND_ENGINE_RAYS;
    case StandEngine::kBoxes:
      return v1::STAND_ENGINE_BOXES;
  }
  return v1::STAND_ENGINE_UNSPECIFIED;
}

void fill_place(const Place& place, v1::Place& message) {
  message.set_latitude_deg(place.latitude_deg);
  message.set_longitude_deg(place.longitude_deg);
  message.set_elevation_m(place.elevation_m);
  message.set_pressure_hpa(place.pressure_hpa);
  message.set_temperature_c(place.temperature_c);
}

void fill_sensor(const SensorRow& row, v1::StandSensor& message) {
  message.set_name(row.sensor.name);
  message.set_x_m(row.sensor.position_m.x);
  message.set_y_m(row.sensor.position_m.y);
  message.set_height_m(row.sensor.height_m);
  message.mutable_normal()->set_x(row.sensor.normal.x);
  message.mutable_normal()->set_y(row.sensor.normal.y);
  message.mutable_normal()->set_z(row.sensor.normal.z);
  if (row.pacl) message.set_pacl(*row.pacl);
  if (row.pacl_direct) message.set_pacl_direct(*row.pacl_direct);
  if (row.pacl_diffuse) message.set_pacl_diffuse(*row.pacl_diffuse);
}

void fill_optics(const OpticsRequest& optics, v1::StandLightSpec& message) {
  for (std::size_t b = 0; b < optics.bands.size(); ++b) {
    v1::StandBand& band = *message.add_bands();
    band.set_name(optics.bands[b]);
    if (b < optics.soil_albedo.size()) band.set_soil_albedo(optics.soil_albedo[b]);
  }
  for (const OpticsOverride& from : optics.overrides) fill_message(from, *message.add_overrides());
}

void fill_map(const StandStudySpec& spec, v1::StandLightSpec& message) {
  message.set_ground_cell_m(spec.ground_cell_m);
  message.set_layer_m(spec.layer_m);
  message.set_plot_area_m2(spec.plot_area_m2);
  if (!spec.map_lo_m || !spec.map_hi_m) return;
  message.mutable_map()->set_x_from_m(spec.map_lo_m->x);
  message.mutable_map()->set_y_from_m(spec.map_lo_m->y);
  message.mutable_map()->set_x_to_m(spec.map_hi_m->x);
  message.mutable_map()->set_y_to_m(spec.map_hi_m->y);
}

std::string field_of(const std::string& path, const StandStudySpec& spec, const std::string& field) {
  const auto begins = [&](const std::string& with) { return path.rfind(with, 0) == 0; };
  if (begins(field + ".")) return path;
  if (begins("sensors[")) return field + "." + path;
  if (begins("stand.")) return field + path.substr(5);
  if (begins("optics.")) return field + ".overrides";
  if (begins("forest") || begins("materials.")) return "scene";
  for (std::size_t b = 0; b < spec.optics.bands.size(); ++b)
    if (path == "bands." + spec.optics.bands[b]) return at(field + ".bands", b);
  return field;
}

}  // namespace

void fill_message(const StandStudySpec& spec, v1::StandLightSpec& message) {
  fill_place(spec.place, *message.mutable_place());
  const TimeSpan& period = spec.period;
  message.mutable_period()->set_from(exact_time_text(period.begin_s, period.offset_minutes));
  message.mutable_period()->set_to(exact_time_text(period.end_s, period.offset_minutes));
  const RadiationTable table = spec.radiation_table ? *spec.radiation_table : read_radiation(spec.radiation);
  fill_message(table, spec.radiation.filename().string(), *message.mutable_radiation());
  message.set_sky(message_sky(spec.sky));
  message.set_intervals(message_intervals(spec.intervals));
  for (const SensorRow& row : spec.sensors) fill_sensor(row, *message.add_sensors());
  fill_optics(spec.optics, message);
  message.set_par_fraction(spec.par.par_fraction);
  message.set_umol_per_j(spec.par.umol_per_j);
  fill_map(spec, message);
  message.set_engine(message_engine(spec.engine));
  message.set_scattering(spec.scattering);
  message.set_canopy_views(spec.canopy_views);
  message.set_rays_per_cell(spec.rays_per_cell);
  message.set_tree_relative_error(spec.tree_relative_error);
  message.set_sensor_sun_rays(spec.sensor_sun_rays);
  message.set_sensor_sky_rays(spec.sensor_sky_rays);
  if (spec.patch_deg > 0.0) message.set_patch_deg(spec.patch_deg);
  if (spec.bin_deg > 0.0) message.set_bin_deg(spec.bin_deg);
  message.set_seed(spec.seed);
}

Violation violation_of(const Error& error) {
  const std::string& where = error.where();
  const std::size_t end = where.find_first_of(":, (");
  std::string place = end == std::string::npos ? "" : where.substr(end) + ": ";
  if (place.rfind(":", 0) == 0) place = "line " + place.substr(1);
  place.erase(0, place.find_first_not_of(", "));
  const std::string remedy = error.remedy().empty() ? "" : " (" + error.remedy() + ")";
  return {where.substr(0, end), place + error.problem() + remedy};
}

Violation violation_of(const Error& error, const StandStudySpec& spec, const std::string& field) {
  Violation violation = violation_of(error);
  const bool is_band = error.where().rfind("bands.", 0) == 0;  // whose name may have spaces
  violation.field = field_of(is_band ? error.where() : violation.field, spec, field);
  return violation;
}

void fill_message(const StandCost& cost, v1::StandLightCost& message) {
  message.set_engine(to_string(cost.engine));
  message.set_intervals(cost.intervals);
  message.set_ground_cells(static_cast<std::uint64_t>(std::min(cost.ground_cells, 1e18)));
  message.set_rays(cost.rays);
  message.set_predicted_memory_bytes(cost.memory_bytes);
  message.set_predicted_result_bytes(cost.result_bytes);
}

StandCost cost_from_message(const v1::StandLightCost& message) {
  StandCost cost;
  cost.engine = message.engine() == to_string(StandEngine::kBoxes) ? StandEngine::kBoxes : StandEngine::kRays;
  cost.intervals = message.intervals();
  cost.ground_cells = static_cast<double>(message.ground_cells());
  cost.rays = message.rays();
  cost.memory_bytes = message.predicted_memory_bytes();
  cost.result_bytes = message.predicted_result_bytes();
  return cost;
}

}  // namespace sunfleck
