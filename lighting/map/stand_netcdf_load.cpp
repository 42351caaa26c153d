// Reads a stand study's tables back.
#include <algorithm>
#include <cmath>
#include <limits>

#include "lighting/map/netcdf_handle.h"
#include "lighting/map/provenance_json.h"
#include "lighting/map/stand_netcdf.h"
#include "lighting/map/stand_netcdf_names.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

bool says_stand_study(const NetcdfHandle& file) {
  std::size_t length = 0;
  nc_type type = NC_NAT;
  return nc_inq_att(file.id(), NC_GLOBAL, stand_file::kFormatName, &type, &length) == NC_NOERR &&
         type == NC_CHAR && file.text_attribute(stand_file::kFormatName) == stand_file::kFormat;
}

class StandReader {
 public:
  explicit StandReader(const NetcdfHandle& file) : file_(file) {}

  StandTables read() {
    require_our_format();
    read_header();
    read_times();
    read_targets();
    int count = 0;
    file_.check(nc_inq_nvars(file_.id(), &count), "variables");
    for (int id = 0; id < count; ++id) read_variable(id);
    check_lengths();
    return std::move(all_);
  }

 private:
  void require_our_format() const {
    if (says_stand_study(file_)) return;
    throw_invalid(file_.shown(), "is a NetCDF file but not a stand study",
                  "name a file that `sunfleck stand --netcdf` wrote");
  }

  // A whole number that its type holds: casting another would be undefined.
  template <class T>
  T whole(double value, const std::string& name) const {
    if (!(value >= static_cast<double>(std::numeric_limits<T>::min()) &&
          value < std::ldexp(1.0, std::numeric_limits<T>::digits)))
      throw_strange(name, "has a value that is impossible");
    return static_cast<T>(value);
  }

  std::string text(int variable, const char* name) const {
    std::size_t length = 0;
    if (nc_inq_attlen(file_.id(), variable, name, &length) != NC_NOERR) return {};
    std::string value(length, '\0');
    file_.check(nc_get_att_text(file_.id(), variable, name, value.data()), name);
    return value;
  }

  std::size_t size(const char* dimension) const {
    int id = 0;
    return nc_inq_dimid(file_.id(), dimension, &id) == NC_NOERR ? file_.dimension(dimension) : 0;
  }

  // Of a coordinate of the rows, or of their two bounds each.
  std::vector<double> rows(const std::string& name, std::size_t count) const {
    return file_.numbers(name, {count});
  }
  std::vector<double> bounds(const std::string& name, std::size_t count) const {
    return file_.numbers(name, {count, 2});
  }

  void read_header() {
    Provenance& p = all_.provenance;
    p.method = file_.text_attribute("method");
    p.version = file_.text_attribute("version");
    p.forest_hash = file_.text_attribute("forest_hash");
    p.seed = file_.seed_attribute();
    read_json({file_.text_attribute("settings"), file_.text_attribute("skipped"),
               file_.text_attribute("notes"), file_.text_attribute("times")},
              file_.shown(), p);
    all_.place = {file_.numbers("latitude", {})[0], file_.numbers("longitude", {})[0],
                  file_.numbers("altitude", {})[0]};
    all_.par = {file_.number_attribute("par_fraction_of_global_energy"),
                file_.number_attribute("par_umol_per_j")};
    all_.virtual_trees =
        whole<std::uint32_t>(file_.number_attribute("virtual_trees_left_out"), "virtual_trees_left_out");
    all_.utc_offset_minutes = whole<int>(file_.number_attribute("utc_offset_minutes"), "utc_offset_minutes");
    all_.layer_area_m2 = file_.number_attribute("layer_area_m2");
    all_.map.periodic = file_.number_attribute("map_is_periodic") != 0;
  }

  void read_times() {
    all_.intervals = {file_.text_attribute("period_name")};
    std::vector<double> ends = rows("period_bnds", 2);
    if (const std::size_t parts = size("time"); parts > 0) {
      for (const std::string& name : file_.texts("interval_name", parts)) all_.intervals.push_back(name);
      const std::vector<double> more = bounds("time_bnds", parts);
      ends.insert(ends.end(), more.begin(), more.end());
    }
    for (std::size_t i = 0; i < ends.size(); i += 2) {
      all_.begin_s.push_back(ends[i]);
      all_.end_s.push_back(ends[i + 1]);
    }
  }

  void read_targets() {
    if (const std::size_t trees = size("tree"); trees > 0) read_trees(trees);
    if (const std::size_t sensors = size("sensor"); sensors > 0) read_sensors(sensors);
    if (size("x") > 0 && size("y") > 0) read_map();
    if (const std::size_t layers = size("layer"); layers > 0) {
      const std::vector<double> ends = bounds("layer_bnds", layers);
      all_.layer_m = ends[1] - ends[0];
    }
    if (const std::size_t angles = size("angle"); angles > 0) all_.angles_deg = rows("angle", angles);
    if (const std::size_t rings = size("ring"); rings > 0) {
      const std::vector<double> ends = bounds("ring_bnds", rings);
      all_.ring_bounds_deg = {ends[0]};
      for (std::size_t i = 1; i < ends.size(); i += 2) all_.ring_bounds_deg.push_back(ends[i]);
    }
  }

  void read_map() {
    const std::vector<double> x = bounds("x_bnds", size("x")), y = bounds("y_bnds", size("y"));
    all_.map.nx = static_cast<std::uint32_t>(x.size() / 2);
    all_.map.ny = static_cast<std::uint32_t>(y.size() / 2);
    all_.map.lo_m = {x[0], y[0]};
    all_.map.cell_m = {x[1] - x[0], y[1] - y[0]};
  }

  void read_trees(std::size_t count) {
    const auto id = rows("tree_id", count), area = rows("tree_leaf_area", count);
    const auto x = rows("tree_x", count), y = rows("tree_y", count), z = rows("tree_z", count);
    const auto species = file_.texts("tree_species", count);
    for (std::size_t t = 0; t < count; ++t)
      all_.trees.push_back({whole<std::uint32_t>(id[t], "tree_id"), species[t], {x[t], y[t], z[t]}, area[t]});
  }

  void read_sensors(std::size_t count) {
    const auto x = rows("sensor_x", count), y = rows("sensor_y", count);
    const auto height = rows("sensor_height", count), nx = rows("sensor_normal_x", count);
    const auto ny = rows("sensor_normal_y", count), nz = rows("sensor_normal_z", count);
    const auto names = file_.texts("sensor_name", count);
    for (std::size_t s = 0; s < count; ++s)
      all_.sensors.push_back({{names[s], {x[s], y[s]}, height[s], {nx[s], ny[s], nz[s]}}, {}, {}, {}});
  }

  StandTable& table_of(const std::string& target) {
    for (StandTable& t : all_.tables)
      if (to_string(t.target) == target) return t;
    StandTable table;
    for (const StandTarget t :
         {StandTarget::kPlot, StandTarget::kTree, StandTarget::kSensor, StandTarget::kGround,
          StandTarget::kLayer, StandTarget::kLevel, StandTarget::kAngle})
      if (to_string(t) == target) table.target = t;
    const std::size_t cells = size("x") * size("y");
    table.rows = table.target == StandTarget::kPlot     ? 1
                 : table.target == StandTarget::kGround ? cells
                                                        : size(target.c_str());
    all_.tables.push_back(std::move(table));
    return all_.tables.back();
  }

  bool has_dimension(int variable, const char* dimension) const {
    int wanted = 0;
    if (nc_inq_dimid(file_.id(), dimension, &wanted) != NC_NOERR) return false;
    const std::vector<int> all = file_.dimensions(variable);
    return std::find(all.begin(), all.end(), wanted) != all.end();
  }

  // The period's variable comes before that of its parts, which go behind its values.
  void read_variable(int id) {
    const std::string target = text(id, stand_file::kTable);
    if (target.empty()) return;
    char raw[NC_MAX_NAME + 1] = {};
    file_.check(nc_inq_varname(file_.id(), id, raw), "variable");
    const std::string full = raw;
    if (!full.starts_with(target + "_")) throw_strange(full, "is not named after its table");
    std::string name = full.substr(target.size() + 1);
    StandTable& table = table_of(target);
    if (has_dimension(id, "time")) {
      if (table.variables.empty()) throw_strange(full, "comes before that of the whole period");
      return append(full, id, table.variables.back());
    }
    StandVariable v;
    v.per_interval = name.ends_with(stand_file::kPeriod);
    if (v.per_interval) name.resize(name.size() - std::string(stand_file::kPeriod).size());
    v.name = name;
    v.units = text(id, "units");
    v.unit_word = text(id, stand_file::kUnitWord);
    v.long_name = text(id, "long_name");
    v.standard_name = text(id, "standard_name");
    v.rings = has_dimension(id, "ring") ? static_cast<int>(size("ring")) : 0;
    append(full, id, v);
    table.variables.push_back(std::move(v));
  }

  void append(const std::string& full, int id, StandVariable& v) const {
    const std::vector<double> more = file_.numbers(full, file_.shape(id));
    v.value.insert(v.value.end(), more.begin(), more.end());
    if (!file_.has_variable(full + stand_file::kError)) return;
    const std::vector<double> errors = file_.numbers(full + stand_file::kError, file_.shape(id));
    v.standard_error.insert(v.standard_error.end(), errors.begin(), errors.end());
  }

  // Readers of the tables count on their lengths.
  void check_lengths() const {
    for (const StandTable& table : all_.tables)
      for (const StandVariable& v : table.variables) {
        const std::size_t row = table.rows * static_cast<std::size_t>(std::max(1, v.rings));
        const std::size_t whole = v.per_interval ? row * all_.intervals.size() : row;
        if (v.value.size() != whole || (!v.standard_error.empty() && v.standard_error.size() != whole))
          throw_strange(stand_file::variable_name(table.target, v), "does not have a value for each row");
      }
  }

  [[noreturn]] void throw_strange(const std::string& variable, const std::string& problem) const {
    throw_invalid(file_.shown(), "variable " + variable + " " + problem,
                  "name a file that `sunfleck stand --netcdf` wrote");
  }

  const NetcdfHandle& file_;
  StandTables all_;
};

}  // namespace

bool is_stand_netcdf(const std::filesystem::path& path) { return says_stand_study(NetcdfHandle::open(path)); }

StandTables load_stand_netcdf(const std::filesystem::path& path) {
  const NetcdfHandle file = NetcdfHandle::open(path);
  return StandReader(file).read();
}

}  // namespace sunfleck
