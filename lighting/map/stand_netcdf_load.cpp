// Reads a stand study's tables back.
#include <algorithm>

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
    return std::move(all_);
  }

 private:
  void require_our_format() const {
    if (says_stand_study(file_)) return;
    throw_invalid(file_.shown(), "is a NetCDF file but not a stand study",
                  "name a file that `sunfleck stand --netcdf` wrote");
  }

  double number(const char* name) const {
    double value = 0;
    file_.check(nc_get_att_double(file_.id(), NC_GLOBAL, name, &value), name);
    return value;
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

  std::vector<double> values(const std::string& name) const {
    int id = 0, rank = 0;
    file_.check(nc_inq_varid(file_.id(), name.c_str(), &id), name);
    file_.check(nc_inq_varndims(file_.id(), id, &rank), name);
    std::vector<int> dimensions(static_cast<std::size_t>(rank));
    file_.check(nc_inq_vardimid(file_.id(), id, dimensions.data()), name);
    std::size_t total = 1;
    for (const int d : dimensions) {
      std::size_t length = 0;
      file_.check(nc_inq_dimlen(file_.id(), d, &length), name);
      total *= length;
    }
    std::vector<double> out(total);
    file_.check(nc_get_var_double(file_.id(), id, out.data()), name);
    return out;
  }

  std::vector<std::string> texts(const char* name, std::size_t count) const {
    const int id = file_.variable(name, {count});
    std::vector<char*> raw(count, nullptr);
    file_.check(nc_get_var_string(file_.id(), id, raw.data()), name);
    std::vector<std::string> out(raw.begin(), raw.end());
    nc_free_string(count, raw.data());
    return out;
  }

  void read_header() {
    Provenance& p = all_.provenance;
    p.method = file_.text_attribute("method");
    p.version = file_.text_attribute("version");
    p.forest_hash = file_.text_attribute("forest_hash");
    unsigned long long seed = 0;
    file_.check(nc_get_att_ulonglong(file_.id(), NC_GLOBAL, "seed", &seed), "seed");
    p.seed = seed;
    read_json({file_.text_attribute("settings"), file_.text_attribute("skipped"),
               file_.text_attribute("notes"), file_.text_attribute("times")},
              file_.shown(), p);
    all_.place = {values("latitude")[0], values("longitude")[0], values("altitude")[0]};
    all_.par = {number("par_fraction_of_global_energy"), number("par_umol_per_j")};
    all_.virtual_trees = static_cast<std::size_t>(number("virtual_trees_left_out"));
    all_.utc_offset_minutes = static_cast<int>(number("utc_offset_minutes"));
    all_.layer_area_m2 = number("layer_area_m2");
    all_.map.periodic = number("map_is_periodic") != 0;
  }

  void read_times() {
    all_.intervals = {file_.text_attribute("period_name")};
    std::vector<double> ends = values("period_bnds");
    if (const std::size_t parts = size("time"); parts > 0) {
      for (const std::string& name : texts("interval_name", parts)) all_.intervals.push_back(name);
      const std::vector<double> more = values("time_bnds");
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
    if (size("layer") > 0) all_.layer_m = values("layer_bnds")[1] - values("layer_bnds")[0];
    if (size("angle") > 0) all_.angles_deg = values("angle");
    if (size("ring") > 0) {
      const std::vector<double> ends = values("ring_bnds");
      all_.ring_bounds_deg = {ends[0]};
      for (std::size_t i = 1; i < ends.size(); i += 2) all_.ring_bounds_deg.push_back(ends[i]);
    }
  }

  void read_map() {
    const std::vector<double> x = values("x_bnds"), y = values("y_bnds");
    all_.map.nx = static_cast<std::uint32_t>(x.size() / 2);
    all_.map.ny = static_cast<std::uint32_t>(y.size() / 2);
    all_.map.lo_m = {x[0], y[0]};
    all_.map.cell_m = {x[1] - x[0], y[1] - y[0]};
  }

  void read_trees(std::size_t count) {
    const auto id = values("tree_id"), x = values("tree_x"), y = values("tree_y"), z = values("tree_z");
    const auto area = values("tree_leaf_area");
    const auto species = texts("tree_species", count);
    for (std::size_t t = 0; t < count; ++t)
      all_.trees.push_back({static_cast<std::uint32_t>(id[t]), species[t], {x[t], y[t], z[t]}, area[t]});
  }

  void read_sensors(std::size_t count) {
    const auto x = values("sensor_x"), y = values("sensor_y"), height = values("sensor_height");
    const auto nx = values("sensor_normal_x"), ny = values("sensor_normal_y"), nz = values("sensor_normal_z");
    const auto names = texts("sensor_name", count);
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
    int wanted = 0, rank = 0;
    if (nc_inq_dimid(file_.id(), dimension, &wanted) != NC_NOERR) return false;
    file_.check(nc_inq_varndims(file_.id(), variable, &rank), "dimensions");
    std::vector<int> dimensions(static_cast<std::size_t>(rank));
    file_.check(nc_inq_vardimid(file_.id(), variable, dimensions.data()), "dimensions");
    return std::find(dimensions.begin(), dimensions.end(), wanted) != dimensions.end();
  }

  // The period's variable comes before that of its parts, which go behind its values.
  void read_variable(int id) {
    const std::string target = text(id, stand_file::kTable);
    if (target.empty()) return;
    char raw[NC_MAX_NAME + 1] = {};
    file_.check(nc_inq_varname(file_.id(), id, raw), "variable");
    const std::string full = raw;
    std::string name = full.substr(target.size() + 1);
    StandTable& table = table_of(target);
    if (has_dimension(id, "time")) return append(full, table.variables.back());
    StandVariable v;
    v.per_interval = name.ends_with(stand_file::kPeriod);
    if (v.per_interval) name.resize(name.size() - std::string(stand_file::kPeriod).size());
    v.name = name;
    v.units = text(id, "units");
    v.unit_word = text(id, stand_file::kUnitWord);
    v.long_name = text(id, "long_name");
    v.standard_name = text(id, "standard_name");
    v.rings = has_dimension(id, "ring") ? static_cast<int>(size("ring")) : 0;
    append(full, v);
    table.variables.push_back(std::move(v));
  }

  void append(const std::string& full, StandVariable& v) const {
    const std::vector<double> more = values(full);
    v.value.insert(v.value.end(), more.begin(), more.end());
    if (!file_.has_variable(full + stand_file::kError)) return;
    const std::vector<double> errors = values(full + stand_file::kError);
    v.standard_error.insert(v.standard_error.end(), errors.begin(), errors.end());
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
