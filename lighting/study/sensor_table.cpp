#include "lighting/study/sensor_table.h"

#include <fstream>
#include <iterator>
#include <map>

#include "sim/base/error.h"
#include "sim/forest/csv_table.h"

namespace sunfleck {
namespace {

std::optional<std::size_t> first_of(const CsvTable& table, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (const auto column = table.column(name)) return column;
  return std::nullopt;
}

std::optional<double> share(const CsvTable& table, std::size_t row, const char* name) {
  const auto column = table.column(name);
  if (!column) return std::nullopt;
  const std::string& text = table.field(row, *column);
  if (text.empty() || text == "NA") return std::nullopt;
  const double value = table.number(row, *column, 0, 100, "a share of above-canopy light, 0 to 1");
  if (value > 1)
    throw_invalid(table.where(row, *column), text + " looks like percent", "a share from 0 to 1");
  return value;
}

Vec3 normal_of(const CsvTable& table, std::size_t row) {
  if (!table.column("nx") && !table.column("ny") && !table.column("nz")) return {0, 0, 1};
  Vec3 normal(0);
  const char* names[] = {"nx", "ny", "nz"};
  for (int axis = 0; axis < 3; ++axis)
    normal[axis] = table.number(row, table.required_column(names[axis]), -1e6, 1e6, "part of a direction");
  return normal;
}

SensorRow sensor_of_row(const CsvTable& table, std::size_t row) {
  SensorRow s;
  if (const auto name = first_of(table, {"id_sensor", "id", "name"})) s.sensor.name = table.field(row, *name);
  s.sensor.position_m = {table.number(row, table.required_column("x"), -1e7, 1e7, "metres east"),
                         table.number(row, table.required_column("y"), -1e7, 1e7, "metres north")};
  if (const auto height = first_of(table, {"h_m", "height_m"}))
    s.sensor.height_m = table.number(row, *height, 1e-3, 200, "metres above the ground, 0.001 to 200");
  s.sensor.normal = normal_of(table, row);
  s.pacl = share(table, row, "pacl");
  s.pacl_direct = share(table, row, "pacl_direct");
  s.pacl_diffuse = share(table, row, "pacl_diffuse");
  return s;
}

}  // namespace

std::vector<SensorRow> parse_sensors(std::string_view csv, const std::string& name) {
  const CsvTable table(csv, name);
  std::vector<SensorRow> sensors;
  std::map<std::string, std::string> place_of_name;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    sensors.push_back(sensor_of_row(table, row));
    const std::string& own = sensors.back().sensor.name;
    if (own.empty()) continue;
    const auto [first, is_new] = place_of_name.emplace(own, table.where(row));
    if (!is_new)
      throw_invalid(table.where(row), "sensor " + own + " was there before, at " + first->second,
                    "give each sensor its own name");
  }
  if (sensors.empty()) throw_invalid(name, "the table has no sensors", "one row per sensor below the header");
  return sensors;
}

std::vector<SensorRow> read_sensors(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in || !std::filesystem::is_regular_file(path))
    throw Error(ErrorKind::kNotFound, path.string(), "cannot be read",
                "give a CSV file with columns id_sensor, x, y, h_m");
  const std::string csv{std::istreambuf_iterator<char>(in), {}};
  return parse_sensors(csv, path.string());
}

}  // namespace sunfleck
