#include "lighting/map/stand_netcdf.h"

#include <map>

#include "lighting/map/netcdf_handle.h"
#include "lighting/map/provenance_json.h"
#include "lighting/map/stand_netcdf_names.h"
#include "lighting/sky/utc_time.h"
#include "sim/base/contract.h"
#include "sim/base/pending_file.h"

namespace sunfleck {
namespace {

using Attributes = std::vector<std::pair<std::string, std::string>>;  // empty values are left out

class StandWriter {
 public:
  StandWriter(const NetcdfHandle& file, const StandTables& all) : file_(file), all_(all) {}

  void write() {
    write_header();
    write_place();
    write_times();
    for (const StandTable& table : all_.tables) write_table(table);
  }

 private:
  std::size_t parts() const { return all_.intervals.size() - 1; }

  int dimension(const std::string& name, std::size_t size) {
    const auto found = dimensions_.find(name);
    if (found != dimensions_.end()) return found->second;
    int id = 0;
    file_.check(nc_def_dim(file_.id(), name.c_str(), size, &id), "dimension " + name);
    dimensions_[name] = id;
    return id;
  }

  int define(const std::string& name, nc_type type, const std::vector<int>& dimensions,
             const Attributes& attributes) {
    int id = 0;
    file_.check(nc_def_var(file_.id(), name.c_str(), type, static_cast<int>(dimensions.size()),
                           dimensions.empty() ? nullptr : dimensions.data(), &id),
                name);
    for (const auto& [key, value] : attributes)
      if (!value.empty()) file_.put_text(id, key, value);
    return id;
  }

  void coordinate(const std::string& name, const std::vector<int>& dimensions, const Attributes& attributes,
                  const std::vector<double>& values) {
    const int id = define(name, NC_DOUBLE, dimensions, attributes);
    file_.check(nc_put_var_double(file_.id(), id, values.data()), name);
  }

  void texts(const std::string& name, int dimension, const Attributes& attributes,
             const std::vector<std::string>& values) {
    const int id = define(name, NC_STRING, {dimension}, attributes);
    std::vector<const char*> raw;
    for (const std::string& v : values) raw.push_back(v.c_str());
    if (!raw.empty()) file_.check(nc_put_var_string(file_.id(), id, raw.data()), name);
  }

  void number(const char* name, double value) {
    file_.check(nc_put_att_double(file_.id(), NC_GLOBAL, name, NC_DOUBLE, 1, &value), name);
  }

  void write_header() {
    const Provenance& p = all_.provenance;
    for (const auto& [name, value] :
         Attributes{{"Conventions", "CF-1.9"},
                    {"title", "Light in a forest stand: trees, ground, layers and sensors over a period"},
                    {"source", "sunfleck " + p.version + ", " + p.method},
                    {"history", "made by sunfleck " + p.version},
                    {"comment",
                     "x east, y north, metres; energies are of global radiation, those of PAR carry par in "
                     "their names"},
                    {stand_file::kFormatName, stand_file::kFormat},
                    {"method", p.method},
                    {"version", p.version},
                    {"forest_hash", p.forest_hash},
                    {"settings", settings_to_json(p)},
                    {"skipped", skipped_to_json(p)},
                    {"notes", notes_to_json(p)},
                    {"times", times_to_json(p)}})
      file_.put_text(NC_GLOBAL, name, value);
    const auto seed = static_cast<unsigned long long>(p.seed);
    file_.check(nc_put_att_ulonglong(file_.id(), NC_GLOBAL, "seed", NC_UINT64, 1, &seed), "attribute seed");
    number("par_fraction_of_global_energy", all_.par.par_fraction);
    number("par_umol_per_j", all_.par.umol_per_j);
    number("virtual_trees_left_out", static_cast<double>(all_.virtual_trees));
    number("utc_offset_minutes", all_.utc_offset_minutes);
    number("layer_area_m2", all_.layer_area_m2);
    number("map_is_periodic", all_.map.periodic ? 1 : 0);
  }

  void write_place() {
    coordinate(
        "latitude", {},
        {{"standard_name", "latitude"}, {"long_name", "latitude of the stand"}, {"units", "degrees_north"}},
        {all_.place.latitude_deg});
    coordinate(
        "longitude", {},
        {{"standard_name", "longitude"}, {"long_name", "longitude of the stand"}, {"units", "degrees_east"}},
        {all_.place.longitude_deg});
    coordinate("altitude", {},
               {{"standard_name", "altitude"},
                {"long_name", "height above sea level"},
                {"units", "m"},
                {"positive", "up"}},
               {all_.place.elevation_m});
  }

  Attributes time_attributes(const std::string& long_name, const std::string& bounds,
                             const char* axis) const {
    return {{"standard_name", "time"}, {"long_name", long_name}, {"units", stand_file::kTimeUnits},
            {"calendar", "standard"},  {"bounds", bounds},       {"axis", axis}};
  }

  void write_times() {
    bounds_ = dimension("bnds", 2);
    coordinate("period", {}, time_attributes("middle of the whole period", "period_bnds", ""),
               {0.5 * (all_.begin_s[0] + all_.end_s[0])});
    coordinate("period_bnds", {bounds_}, {}, {all_.begin_s[0], all_.end_s[0]});
    file_.put_text(NC_GLOBAL, "period_name", all_.intervals[0]);
    if (parts() == 0) return;
    const int time = dimension("time", parts());
    std::vector<double> middle, ends;
    for (std::size_t i = 1; i <= parts(); ++i) {
      middle.push_back(0.5 * (all_.begin_s[i] + all_.end_s[i]));
      ends.insert(ends.end(), {all_.begin_s[i], all_.end_s[i]});
    }
    coordinate("time", {time}, time_attributes("middle of the interval", "time_bnds", "T"), middle);
    coordinate("time_bnds", {time, bounds_}, {}, ends);
    texts("interval_name", time, {{"long_name", "name of the interval, of the local clock"}},
          {all_.intervals.begin() + 1, all_.intervals.end()});
  }

  // Edges of equal steps as a coordinate with bounds.
  int steps(const std::string& name, std::size_t count, double from, double step, Attributes attributes) {
    const int id = dimension(name, count);
    std::vector<double> middle, ends;
    for (std::size_t k = 0; k < count; ++k) {
      const double lo = from + step * static_cast<double>(k);
      middle.push_back(lo + 0.5 * step);
      ends.insert(ends.end(), {lo, lo + step});
    }
    attributes.emplace_back("bounds", name + "_bnds");
    coordinate(name, {id}, attributes, middle);
    coordinate(name + "_bnds", {id, bounds_}, {}, ends);
    return id;
  }

  std::vector<int> ground_dimensions() {
    const StandGround& map = all_.map;
    const int y =
        steps("y", map.ny, map.lo_m.y, map.cell_m.y, {{"units", "m"}, {"long_name", "north"}, {"axis", "Y"}});
    const int x =
        steps("x", map.nx, map.lo_m.x, map.cell_m.x, {{"units", "m"}, {"long_name", "east"}, {"axis", "X"}});
    return {y, x};
  }

  int tree_dimension() {
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

  int sensor_dimension() {
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

  std::vector<int> target_dimensions(const StandTable& table) {
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

  int ring_dimension(int rings) {
    if (const auto found = dimensions_.find("ring"); found != dimensions_.end()) return found->second;
    const double step = all_.ring_bounds_deg[1] - all_.ring_bounds_deg[0];
    return steps("ring", static_cast<std::size_t>(rings), all_.ring_bounds_deg[0], step,
                 {{"units", "degree"}, {"long_name", "zenith angle of the ring"}});
  }

  static const char* coordinates_of(StandTarget target) {
    if (target == StandTarget::kTree) return "tree_id tree_species tree_x tree_y";
    if (target == StandTarget::kSensor) return "sensor_name sensor_x sensor_y sensor_height";
    return "";
  }

  void write_table(const StandTable& table) {
    const std::vector<int> at = target_dimensions(table);
    for (const StandVariable& v : table.variables) write_variable(table, v, at);
  }

  void write_variable(const StandTable& table, const StandVariable& v, std::vector<int> at) {
    if (v.rings > 0) at.push_back(ring_dimension(v.rings));
    const std::size_t row = table.rows * static_cast<std::size_t>(std::max(1, v.rings));
    const std::string name = stand_file::variable_name(table.target, v);
    if (!v.per_interval) return write_pair(table, v, name, at, 0, row, "");
    SUNFLECK_EXPECTS(v.value.size() == row * all_.intervals.size());
    write_pair(table, v, name + stand_file::kPeriod, at, 0, row, "period");
    if (parts() == 0) return;
    at.insert(at.begin(), dimensions_.at("time"));
    write_pair(table, v, name, at, row, row * parts(), "time");
  }

  // The values and, where there are, their errors.
  void write_pair(const StandTable& table, const StandVariable& v, const std::string& name,
                  const std::vector<int>& at, std::size_t first, std::size_t count, const std::string& time) {
    const bool has_error = !v.standard_error.empty();
    std::string coordinates = coordinates_of(table.target);
    if (time == "period") coordinates += coordinates.empty() ? "period" : " period";
    coordinates += coordinates.empty() ? "latitude longitude" : " latitude longitude";
    const bool is_sum = !v.unit_word.empty() && v.unit_word != "m2" && !time.empty();
    const auto write = [&](const std::string& own, const std::vector<double>& values,
                           const Attributes& more) {
      Attributes attributes{
          {"units", v.units}, {"coordinates", coordinates}, {"cell_methods", is_sum ? time + ": sum" : ""}};
      attributes.insert(attributes.end(), more.begin(), more.end());
      write_values(own, table.target == StandTarget::kPlot ? NC_DOUBLE : NC_FLOAT, at, attributes,
                   {values.begin() + static_cast<std::ptrdiff_t>(first),
                    values.begin() + static_cast<std::ptrdiff_t>(first + count)});
    };
    write(name, v.value,
          {{"long_name", v.long_name},
           {"standard_name", v.standard_name},
           {"ancillary_variables", has_error ? name + stand_file::kError : ""},
           {stand_file::kTable, to_string(table.target)},
           {stand_file::kUnitWord, v.unit_word}});
    if (!has_error) return;
    const std::string standard_name = v.standard_name.empty() ? "" : v.standard_name + " standard_error";
    write(name + stand_file::kError, v.standard_error,
          {{"long_name", "standard error of " + name}, {"standard_name", standard_name}});
  }

  void write_values(const std::string& name, nc_type type, const std::vector<int>& at,
                    const Attributes& attributes, const std::vector<double>& values) {
    const int id = define(name, type, at, attributes);
    if (type == NC_FLOAT) {
      const float missing = static_cast<float>(std::numeric_limits<double>::quiet_NaN());
      file_.check(nc_put_att_float(file_.id(), id, "_FillValue", NC_FLOAT, 1, &missing), "_FillValue");
      if (!at.empty()) file_.check(nc_def_var_deflate(file_.id(), id, 1, 1, 1), name);
    }
    file_.check(nc_put_var_double(file_.id(), id, values.data()), name);
  }

  const NetcdfHandle& file_;
  const StandTables& all_;
  std::map<std::string, int> dimensions_;
  int bounds_ = 0;
};

}  // namespace

void save_stand_netcdf(const StandTables& tables, const std::filesystem::path& path) {
  PendingFile pending(path);
  {
    NetcdfHandle file = NetcdfHandle::create(pending.path(), path);
    StandWriter(file, tables).write();
    file.close();
  }
  pending.commit();
}

}  // namespace sunfleck
