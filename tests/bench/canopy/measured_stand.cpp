// See measured_stand.h.
#include "tests/bench/canopy/measured_stand.h"

#include <cmath>
#include <fstream>
#include <iterator>

#include "sim/forest/csv_table.h"
#include "sim/forest/forest_spec.h"

namespace sunfleck::bench {

namespace {

CsvTable read_table(const std::filesystem::path& path) {
  std::ifstream in(path);
  return {std::string{std::istreambuf_iterator<char>(in), {}}, path.filename().string()};
}

double value(const CsvTable& table, std::size_t row, const char* column) {
  return table.number(row, table.required_column(column), -1e9, 1e9, "a number");
}

void read_sensors(const CsvTable& table, MeasuredStand& stand) {
  for (std::size_t i = 0; i < table.rows(); ++i) {
    LightSensor sensor;
    sensor.name = table.field(i, table.required_column("id_sensor"));
    sensor.position_m = {value(table, i, "x"), value(table, i, "y")};
    sensor.height_m = value(table, i, "h_m");
    stand.sensors.push_back(sensor);
    stand.pacl.push_back(value(table, i, "pacl"));
    stand.pacl_direct.push_back(value(table, i, "pacl_direct"));
    stand.pacl_diffuse.push_back(value(table, i, "pacl_diffuse"));
  }
}

}  // namespace

MeasuredStand measured_stand(const std::filesystem::path& folder, int leaves, bool periodic) {
  MeasuredStand stand;
  ForestSpec spec;
  spec.name = folder.filename().string();
  spec.trees = TreeSource::kCrown;
  spec.elements_per_tree = leaves;
  spec.inventory = read_inventory(folder / "trees.csv");
  stand.map_lo_m = Vec2(1e9);
  stand.map_hi_m = Vec2(-1e9);
  for (const InventoryTree& tree : spec.inventory) {
    stand.map_lo_m = glm::min(stand.map_lo_m, Vec2(tree.x_m, tree.y_m));
    stand.map_hi_m = glm::max(stand.map_hi_m, Vec2(tree.x_m, tree.y_m));
  }
  stand.map_lo_m = glm::floor(stand.map_lo_m);
  stand.map_hi_m = glm::ceil(stand.map_hi_m);
  if (std::filesystem::exists(folder / "sensors_measured.csv")) {
    stand.map_lo_m = {0, 0};  // the square that the authors use
    stand.map_hi_m = {100, 100};
    read_sensors(read_table(folder / "sensors_measured.csv"), stand);
  }
  if (periodic) spec.period = Period{stand.map_lo_m, stand.map_hi_m - stand.map_lo_m};
  const auto species = SpeciesLibrary::load(std::filesystem::path(SUNFLECK_SOURCE_DIR) / "configs/species");
  stand.forest = grow_forest(spec, species, {});
  return stand;
}

Agreement agreement(const std::vector<double>& ours, const std::vector<double>& measured) {
  const double n = static_cast<double>(ours.size());
  double sx = 0, sy = 0, xx = 0, yy = 0, xy = 0, squares = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const double x = measured[i], y = ours[i];
    sx += x / n, sy += y / n, xx += x * x / n, yy += y * y / n, xy += x * y / n;
    squares += (y - x) * (y - x) / n;
  }
  const double vx = xx - sx * sx, vy = yy - sy * sy;
  return {std::sqrt(squares), sy - sx, (xy - sx * sy) / std::sqrt(vx * vy), std::sqrt(vy)};
}

}  // namespace sunfleck::bench
