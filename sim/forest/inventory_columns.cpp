#include "sim/forest/inventory_columns.h"

#include <array>
#include <set>

namespace sunfleck {
namespace {

struct KnownName {
  const char* name;
  InventoryField field;
  double factor = 1;
  bool unit_stated = true;
};

using F = InventoryField;
// DBH in cm, lengths in m.
constexpr std::array kNames = std::to_array<KnownName>({{"id_tree", F::kId},
                                                        {"id", F::kId},
                                                        {"tree_id", F::kId},
                                                        {"tree", F::kId},
                                                        {"species", F::kSpecies},
                                                        {"sp", F::kSpecies},
                                                        {"species_code", F::kSpecies},
                                                        {"x", F::kX},
                                                        {"x_m", F::kX},
                                                        {"east", F::kX},
                                                        {"east_m", F::kX},
                                                        {"y", F::kY},
                                                        {"y_m", F::kY},
                                                        {"north", F::kY},
                                                        {"north_m", F::kY},
                                                        {"lon", F::kLongitude},
                                                        {"longitude", F::kLongitude},
                                                        {"lon_deg", F::kLongitude},
                                                        {"lat", F::kLatitude},
                                                        {"latitude", F::kLatitude},
                                                        {"lat_deg", F::kLatitude},
                                                        {"dbh_cm", F::kDbh},
                                                        {"dbh_m", F::kDbh, 100},
                                                        {"dbh_mm", F::kDbh, 0.1},
                                                        {"dbh", F::kDbh, 1, false},
                                                        {"h_m", F::kHeight},
                                                        {"height_m", F::kHeight},
                                                        {"h_cm", F::kHeight, 0.01},
                                                        {"height_cm", F::kHeight, 0.01},
                                                        {"h", F::kHeight, 1, false},
                                                        {"height", F::kHeight, 1, false},
                                                        {"hbase_m", F::kCrownBase},
                                                        {"crown_base_m", F::kCrownBase},
                                                        {"hcb_m", F::kCrownBase},
                                                        {"hmax_m", F::kWidest},
                                                        {"rn_m", F::kRadiusNorth},
                                                        {"rs_m", F::kRadiusSouth},
                                                        {"re_m", F::kRadiusEast},
                                                        {"rw_m", F::kRadiusWest},
                                                        {"crown_radius_m", F::kRadius},
                                                        {"r_m", F::kRadius},
                                                        {"crown_lad", F::kLeafAreaDensity},
                                                        {"crown_type", F::kCrownType},
                                                        {"form", F::kForm}});

// Known to other programs, of no use here, no reason for a warning.
const std::set<std::string>& ignored_names() {
  static const std::set<std::string> names = {"age", "crown_openness", "status", "z", "count"};
  return names;
}

const KnownName* known(const std::string& name) {
  for (const KnownName& entry : kNames)
    if (name == entry.name) return &entry;
  return nullptr;
}

void require(const InventoryColumns& columns, const CsvTable& table, InventoryField field, const char* name,
             const char* meaning, std::vector<InventoryProblem>& problems) {
  if (columns.find(field) != nullptr) return;
  problems.push_back({Severity::kError, table.header_where() + ", column " + name, "the column is missing",
                      std::string(meaning) + "; the table has the columns " + table.column_names()});
}

void require_place(const InventoryColumns& columns, const CsvTable& table,
                   std::vector<InventoryProblem>& problems) {
  const bool degrees = columns.find(F::kLongitude) != nullptr || columns.find(F::kLatitude) != nullptr;
  require(columns, table, degrees ? F::kLongitude : F::kX, degrees ? "lon" : "x",
          degrees ? "degrees east" : "metres east, or give lon and lat", problems);
  require(columns, table, degrees ? F::kLatitude : F::kY, degrees ? "lat" : "y",
          degrees ? "degrees north" : "metres north, or give lon and lat", problems);
  if (degrees && (columns.find(F::kX) != nullptr || columns.find(F::kY) != nullptr))
    problems.push_back({Severity::kError, table.header_where(), "there are both plane and geographic places",
                        "keep x and y, or lon and lat"});
}

}  // namespace

InventoryColumns inventory_columns(const CsvTable& table, std::vector<InventoryProblem>& problems) {
  InventoryColumns columns;
  for (std::size_t i = 0; i < table.columns(); ++i) {
    const std::string& name = table.column_name(i);
    const KnownName* entry = known(name);
    if (entry == nullptr) {
      if (!ignored_names().contains(name)) columns.unknown.push_back(name);
      continue;
    }
    const auto [place, is_new] =
        columns.of.emplace(entry->field, InventoryColumn{i, entry->factor, entry->unit_stated});
    if (is_new) continue;
    problems.push_back({Severity::kError, table.header_where() + ", column " + name,
                        "says the same as column " + table.column_name(place->second.index),
                        "keep one of the two"});
  }
  // iLand's list has bare names and no tree numbers.
  columns.counts_trees = columns.find(F::kId) == nullptr && table.column("dbh") && table.column("height");
  if (!columns.counts_trees)
    require(columns, table, F::kId, "id_tree", "a whole number for each tree", problems);
  require(columns, table, F::kSpecies, "species", "a name of the species library", problems);
  require(columns, table, F::kDbh, "dbh_cm", "the stem diameter at 1.3 m", problems);
  require_place(columns, table, problems);
  for (const std::string& name : columns.unknown)
    problems.push_back({Severity::kWarning, table.header_where() + ", column " + name,
                        "the column is not used",
                        "see `sunfleck inventory --help` for the columns there are"});
  return columns;
}

}  // namespace sunfleck
