#include "lighting/map/stand_csv.h"

#include "lighting/map/csv_writer.h"
#include "lighting/sky/utc_time.h"

namespace sunfleck {
namespace {

// What stands before the variables on every line: who the target is.
class Keys {
 public:
  Keys(const StandTables& all, StandTarget target) : all_(all), target_(target) {}

  const char* header() const {
    switch (target_) {
      case StandTarget::kTree:
        return "tree_id,species,x_m,y_m,leaf_area_m2";
      case StandTarget::kSensor:
        return "sensor,x_m,y_m,height_m";
      case StandTarget::kGround:
        return "cell_x,cell_y,x_m,y_m";
      case StandTarget::kLayer:
        return "from_m,to_m";
      case StandTarget::kAngle:
        return "zenith_deg";
      case StandTarget::kPlot:
      case StandTarget::kLevel:
        break;
    }
    return nullptr;
  }

  void write(CsvWriter& csv, std::size_t row) const {
    if (target_ == StandTarget::kTree) write_tree(csv, all_.trees[row]);
    if (target_ == StandTarget::kSensor) write_sensor(csv, row);
    if (target_ == StandTarget::kGround) write_cell(csv, row);
    if (target_ == StandTarget::kAngle) csv.number(all_.angles_deg[row]);
    if (target_ == StandTarget::kLayer) {
      csv.number(all_.layer_m * static_cast<double>(row));
      csv.number(all_.layer_m * static_cast<double>(row + 1));
    }
  }

 private:
  static void write_tree(CsvWriter& csv, const TreeRow& tree) {
    csv.number(tree.id);
    csv.text(csv_quoted(tree.species));
    csv.number(tree.foot_m.x);
    csv.number(tree.foot_m.y);
    csv.number(tree.leaf_area_m2);
  }
  void write_sensor(CsvWriter& csv, std::size_t row) const {
    const LightSensor& sensor = all_.sensors[row].sensor;
    csv.text(csv_quoted(sensor.name.empty() ? std::to_string(row + 1) : sensor.name));
    csv.number(sensor.position_m.x);
    csv.number(sensor.position_m.y);
    csv.number(sensor.height_m);
  }
  void write_cell(CsvWriter& csv, std::size_t row) const {
    const Vec2 centre = all_.map.centre_m(row);
    csv.number(row % all_.map.nx);
    csv.number(row / all_.map.nx);
    csv.number(centre.x);
    csv.number(centre.y);
  }

  const StandTables& all_;
  StandTarget target_;
};

void write_value(CsvWriter& csv, double value) {
  if (std::isnan(value))
    csv.text("");
  else
    csv.number(value);
}

std::string with_suffix(const StandVariable& v, const std::string& suffix) {
  return v.unit_word.empty() ? v.name + suffix : v.name + suffix + "_" + v.unit_word;
}

std::string ring_suffix(const StandTables& all, int ring) {
  const auto whole = [](double deg) { return std::to_string(static_cast<int>(std::lround(deg))); };
  return "_" + whole(all.ring_bounds_deg[static_cast<std::size_t>(ring)]) + "_" +
         whole(all.ring_bounds_deg[static_cast<std::size_t>(ring) + 1]) + "_deg";
}

void write_names(CsvWriter& csv, const StandTables& all, const StandTable& table) {
  for (const StandVariable& v : table.variables)
    for (int ring = 0; ring < std::max(1, v.rings); ++ring) {
      const std::string suffix = v.rings > 0 ? ring_suffix(all, ring) : "";
      csv.text(with_suffix(v, suffix));
      if (!v.standard_error.empty()) csv.text(with_suffix(v, suffix + "_standard_error"));
    }
}

void write_values(CsvWriter& csv, const StandTable& table, std::size_t interval, std::size_t row) {
  for (const StandVariable& v : table.variables) {
    const auto rings = static_cast<std::size_t>(std::max(1, v.rings));
    for (std::size_t ring = 0; ring < rings; ++ring) {
      const std::size_t at = ((v.per_interval ? interval * table.rows : 0) + row) * rings + ring;
      write_value(csv, v.value[at]);
      if (!v.standard_error.empty()) write_value(csv, v.standard_error[at]);
    }
  }
}

// Light shares live between the layers: the foot and the top of each get theirs.
void write_level_names(CsvWriter& csv) {
  for (const char* name : {"light_share_at_foot", "light_share_at_foot_standard_error", "light_share_at_top",
                           "light_share_at_top_standard_error"})
    csv.text(name);
}

void write_levels(CsvWriter& csv, const StandTable& levels, std::size_t interval, std::size_t row) {
  const StandVariable& share = levels.variables.front();
  for (const std::size_t level : {row, row + 1}) {
    csv.number(share.value[interval * levels.rows + level]);
    csv.number(share.standard_error[interval * levels.rows + level]);
  }
}

void write_interval(CsvWriter& csv, const StandTables& all, std::size_t interval) {
  csv.text(interval == 0 ? "period" : csv_quoted(all.intervals[interval]));
  csv.text(local_time_text(all.begin_s[interval], all.utc_offset_minutes));
  csv.text(local_time_text(all.end_s[interval], all.utc_offset_minutes));
}

void save_table(const StandTables& all, const StandTable& table, const std::filesystem::path& path) {
  const Keys keys(all, table.target);
  const bool timeless = table.target == StandTarget::kAngle;
  const StandTable* levels = table.target == StandTarget::kLayer ? all.find(StandTarget::kLevel) : nullptr;
  write_csv(path, [&](CsvWriter& csv) {
    if (!timeless) csv.text("interval,begin,end");
    if (keys.header()) csv.text(keys.header());
    write_names(csv, all, table);
    if (levels) write_level_names(csv);
    csv.end_line();
    for (std::size_t i = 0; i < (timeless ? 1 : all.intervals.size()); ++i)
      for (std::size_t row = 0; row < table.rows; ++row) {
        if (!timeless) write_interval(csv, all, i);
        keys.write(csv, row);
        write_values(csv, table, i, row);
        if (levels) write_levels(csv, *levels, i, row);
        csv.end_line();
      }
  });
}

const char* file_of(StandTarget target) {
  switch (target) {
    case StandTarget::kPlot:
      return "plot.csv";
    case StandTarget::kTree:
      return "trees.csv";
    case StandTarget::kSensor:
      return "sensors.csv";
    case StandTarget::kGround:
      return "ground.csv";
    case StandTarget::kLayer:
      return "layers.csv";
    case StandTarget::kAngle:
      return "leaf_projection.csv";
    case StandTarget::kLevel:
      break;
  }
  return nullptr;
}

}  // namespace

std::vector<std::filesystem::path> save_stand_csv(const StandTables& tables,
                                                  const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directory(folder, failure);
  if (failure) throw_cannot_write(folder, failure.message());
  std::vector<std::filesystem::path> written;
  for (const StandTable& table : tables.tables)
    if (const char* name = file_of(table.target)) {
      save_table(tables, table, folder / name);
      written.push_back(folder / name);
    }
  return written;
}

}  // namespace sunfleck
