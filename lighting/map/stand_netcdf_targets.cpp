#include "lighting/map/stand_netcdf_targets.h"

namespace sunfleck {

int StandTargets::dimension(const std::string& name, std::size_t size) {
  const auto found = dimensions_.find(name);
  if (found != dimensions_.end()) return found->second;
  int id = 0;
  file_.check(nc_def_dim(file_.id(), name.c_str(), size, &id), "dimension " + name);
  dimensions_[name] = id;
  return id;
}

int StandTargets::define(const std::string& name, nc_type type, const std::vector<int>& dimensions,
                         const Attributes& attributes) {
  int id = 0;
  file_.check(nc_def_var(file_.id(), name.c_str(), type, static_cast<int>(dimensions.size()),
                         dimensions.empty() ? nullptr : dimensions.data(), &id),
              name);
  for (const auto& [key, value] : attributes)
    if (!value.empty()) file_.put_text(id, key, value);
  return id;
}

void StandTargets::coordinate(const std::string& name, const std::vector<int>& dimensions,
                              const Attributes& attributes, const std::vector<double>& values) {
  const int id = define(name, NC_DOUBLE, dimensions, attributes);
  file_.check(nc_put_var_double(file_.id(), id, values.data()), name);
}

void StandTargets::texts(const std::string& name, int dimension, const Attributes& attributes,
                         const std::vector<std::string>& values) {
  const int id = define(name, NC_STRING, {dimension}, attributes);
  std::vector<const char*> raw;
  for (const std::string& v : values) raw.push_back(v.c_str());
  if (!raw.empty()) file_.check(nc_put_var_string(file_.id(), id, raw.data()), name);
}

// Edges of equal steps as a coordinate with bounds.
int StandTargets::steps(const std::string& name, std::size_t count, double from, double step,
                        Attributes attributes) {
  const int id = dimension(name, count);
  std::vector<double> middle, ends;
  for (std::size_t k = 0; k < count; ++k) {
    const double lo = from + step * static_cast<double>(k);
    middle.push_back(lo + 0.5 * step);
    ends.insert(ends.end(), {lo, lo + step});
  }
  attributes.emplace_back("bounds", name + "_bnds");
  coordinate(name, {id}, attributes, middle);
  coordinate(name + "_bnds", {id, bounds()}, {}, ends);
  return id;
}

std::vector<int> StandTargets::ground_dimensions() {
  const StandGround& map = all_.map;
  const int y =
      steps("y", map.ny, map.lo_m.y, map.cell_m.y, {{"units", "m"}, {"long_name", "north"}, {"axis", "Y"}});
  const int x =
      steps("x", map.nx, map.lo_m.x, map.cell_m.x, {{"units", "m"}, {"long_name", "east"}, {"axis", "X"}});
  return {y, x};
}

int StandTargets::tree_dimension() {
  const int tree = dimension("tree", all_.trees.size());
  std::vector<std::string> species;
  std::vector<unsigned> ids;
  std::vector<double> x, y, z, area;
  for (const TreeRow& t : all_.trees) {
    species.push_back(t.species);
    ids.push_back(t.id);
    x.push_back(t.foot_m.x), y.push_back(t.foot_m.y), z.push_back(t.foot_m.z);
    area.push_back(t.leaf_area_m2);
  }
  const int id = define("tree_id", NC_UINT, {tree}, {{"long_name", "number of the tree in its inventory"}});
  file_.check(nc_put_var_uint(file_.id(), id, ids.data()), "tree_id");
  texts("tree_species", tree, {{"long_name", "species"}}, species);
  coordinate("tree_x", {tree}, {{"units", "m"}, {"long_name", "stem foot, east"}}, x);
  coordinate("tree_y", {tree}, {{"units", "m"}, {"long_name", "stem foot, north"}}, y);
  coordinate("tree_z", {tree}, {{"units", "m"}, {"long_name", "stem foot, up"}}, z);
  coordinate("tree_leaf_area", {tree}, {{"units", "m2"}, {"long_name", "one-sided leaf area of the tree"}},
             area);
  return tree;
}

int StandTargets::sensor_dimension() {
  const int sensor = dimension("sensor", all_.sensors.size());
  std::vector<std::string> names;
  std::vector<double> x, y, height, nx, ny, nz;
  for (const SensorRow& row : all_.sensors) {
    const LightSensor& s = row.sensor;
    names.push_back(s.name.empty() ? std::to_string(names.size() + 1) : s.name);
    x.push_back(s.position_m.x), y.push_back(s.position_m.y), height.push_back(s.height_m);
    nx.push_back(s.normal.x), ny.push_back(s.normal.y), nz.push_back(s.normal.z);
  }
  texts("sensor_name", sensor, {{"long_name", "name of the sensor"}}, names);
  coordinate("sensor_x", {sensor}, {{"units", "m"}, {"long_name", "east"}}, x);
  coordinate("sensor_y", {sensor}, {{"units", "m"}, {"long_name", "north"}}, y);
  coordinate("sensor_height", {sensor},
             {{"units", "m"},
              {"standard_name", "height"},
              {"long_name", "height above the ground"},
              {"positive", "up"}},
             height);
  coordinate("sensor_normal_x", {sensor}, {{"units", "1"}, {"long_name", "receiver's normal, east"}}, nx);
  coordinate("sensor_normal_y", {sensor}, {{"units", "1"}, {"long_name", "receiver's normal, north"}}, ny);
  coordinate("sensor_normal_z", {sensor}, {{"units", "1"}, {"long_name", "receiver's normal, up"}}, nz);
  return sensor;
}

std::vector<int> StandTargets::target_dimensions(const StandTable& table) {
  const Attributes height{{"units", "m"}, {"standard_name", "height"}, {"positive", "up"}};
  switch (table.target) {
    case StandTarget::kPlot:
      return {};
    case StandTarget::kTree:
      return {tree_dimension()};
    case StandTarget::kSensor:
      return {sensor_dimension()};
    case StandTarget::kGround:
      return ground_dimensions();
    case StandTarget::kLayer:
      return {steps("layer", table.rows, 0, all_.layer_m, height)};
    case StandTarget::kLevel: {
      const int level = dimension("level", table.rows);
      std::vector<double> values;
      for (std::size_t k = 0; k < table.rows; ++k) values.push_back(all_.layer_m * static_cast<double>(k));
      coordinate("level", {level}, height, values);
      return {level};
    }
    case StandTarget::kAngle:
      break;
  }
  const int angle = dimension("angle", table.rows);
  coordinate("angle", {angle}, {{"units", "degree"}, {"long_name", "zenith angle"}}, all_.angles_deg);
  return {angle};
}

int StandTargets::ring_dimension(int rings) {
  if (const auto found = dimensions_.find("ring"); found != dimensions_.end()) return found->second;
  const double step = all_.ring_bounds_deg[1] - all_.ring_bounds_deg[0];
  return steps("ring", static_cast<std::size_t>(rings), all_.ring_bounds_deg[0], step,
               {{"units", "degree"}, {"long_name", "zenith angle of the ring"}});
}

}  // namespace sunfleck
