#include "lighting/map/stand_netcdf.h"

#include "lighting/map/netcdf_handle.h"
#include "lighting/map/provenance_json.h"
#include "lighting/map/stand_netcdf_names.h"
#include "lighting/map/stand_netcdf_targets.h"
#include "lighting/sky/utc_time.h"
#include "sim/base/contract.h"
#include "sim/base/pending_file.h"

namespace sunfleck {
namespace {

class StandWriter {
 public:
  StandWriter(const NetcdfHandle& file, const StandTables& all)
      : file_(file), all_(all), targets_(file, all) {}

  void write() {
    write_header();
    write_place();
    write_times();
    for (const StandTable& table : all_.tables) write_table(table);
  }

 private:
  std::size_t parts() const { return all_.intervals.size() - 1; }

  void number(const char* name, double value) {
    file_.check(nc_put_att_double(file_.id(), NC_GLOBAL, name, NC_DOUBLE, 1, &value), name);
  }

  void write_header() {
    const Provenance& p = all_.provenance;
    for (const auto& [name, value] : StandTargets::Attributes{
             {"Conventions", "CF-1.9"},
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
    targets_.coordinate(
        "latitude", {},
        {{"standard_name", "latitude"}, {"long_name", "latitude of the stand"}, {"units", "degrees_north"}},
        {all_.place.latitude_deg});
    targets_.coordinate(
        "longitude", {},
        {{"standard_name", "longitude"}, {"long_name", "longitude of the stand"}, {"units", "degrees_east"}},
        {all_.place.longitude_deg});
    targets_.coordinate("altitude", {},
                        {{"standard_name", "altitude"},
                         {"long_name", "height above sea level"},
                         {"units", "m"},
                         {"positive", "up"}},
                        {all_.place.elevation_m});
  }

  StandTargets::Attributes time_attributes(const std::string& long_name, const std::string& bounds,
                                           const char* axis) const {
    return {{"standard_name", "time"}, {"long_name", long_name}, {"units", stand_file::kTimeUnits},
            {"calendar", "standard"},  {"bounds", bounds},       {"axis", axis}};
  }

  void write_times() {
    targets_.coordinate("period", {}, time_attributes("middle of the whole period", "period_bnds", ""),
                        {0.5 * (all_.begin_s[0] + all_.end_s[0])});
    targets_.coordinate("period_bnds", {targets_.bounds()}, {}, {all_.begin_s[0], all_.end_s[0]});
    file_.put_text(NC_GLOBAL, "period_name", all_.intervals[0]);
    if (parts() == 0) return;
    const int time = targets_.dimension("time", parts());
    std::vector<double> middle, ends;
    for (std::size_t i = 1; i <= parts(); ++i) {
      middle.push_back(0.5 * (all_.begin_s[i] + all_.end_s[i]));
      ends.insert(ends.end(), {all_.begin_s[i], all_.end_s[i]});
    }
    targets_.coordinate("time", {time}, time_attributes("middle of the interval", "time_bnds", "T"), middle);
    targets_.coordinate("time_bnds", {time, targets_.bounds()}, {}, ends);
    targets_.texts("interval_name", time, {{"long_name", "name of the interval, of the local clock"}},
                   {all_.intervals.begin() + 1, all_.intervals.end()});
  }

  static const char* coordinates_of(StandTarget target) {
    if (target == StandTarget::kTree) return "tree_id tree_species tree_x tree_y";
    if (target == StandTarget::kSensor) return "sensor_name sensor_x sensor_y sensor_height";
    return "";
  }

  void write_table(const StandTable& table) {
    const std::vector<int> at = targets_.target_dimensions(table);
    for (const StandVariable& v : table.variables) write_variable(table, v, at);
  }

  void write_variable(const StandTable& table, const StandVariable& v, std::vector<int> at) {
    if (v.rings > 0) at.push_back(targets_.ring_dimension(v.rings));
    const std::size_t row = table.rows * static_cast<std::size_t>(std::max(1, v.rings));
    const std::string name = stand_file::variable_name(table.target, v);
    if (!v.per_interval) return write_pair(table, v, name, at, 0, row, "");
    SUNFLECK_EXPECTS(v.value.size() == row * all_.intervals.size());
    write_pair(table, v, name + stand_file::kPeriod, at, 0, row, "period");
    if (parts() == 0) return;
    at.insert(at.begin(), targets_.dimension("time", parts()));
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
                           const StandTargets::Attributes& more) {
      StandTargets::Attributes attributes{
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
                    const StandTargets::Attributes& attributes, const std::vector<double>& values) {
    const int id = targets_.define(name, type, at, attributes);
    if (type == NC_FLOAT) {
      const float missing = static_cast<float>(std::numeric_limits<double>::quiet_NaN());
      file_.check(nc_put_att_float(file_.id(), id, "_FillValue", NC_FLOAT, 1, &missing), "_FillValue");
      if (!at.empty()) file_.check(nc_def_var_deflate(file_.id(), id, 1, 1, 1), name);
    }
    file_.check(nc_put_var_double(file_.id(), id, values.data()), name);
  }

  const NetcdfHandle& file_;
  const StandTables& all_;
  StandTargets targets_;
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
