// Which column of a table carries which measure, and in which unit.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sim/forest/csv_table.h"
#include "sim/forest/inventory.h"

namespace sunfleck {

enum class InventoryField {
  kId,
  kSpecies,
  kX,
  kY,
  kLongitude,
  kLatitude,
  kDbh,
  kHeight,
  kCrownBase,
  kWidest,
  kRadiusNorth,
  kRadiusSouth,
  kRadiusEast,
  kRadiusWest,
  kRadius,
  kLeafAreaDensity,
  kCrownType,
  kForm
};

struct InventoryColumn {
  std::size_t index = 0;
  double factor = 1;        // value of the table * factor = our unit (cm for the DBH, m else)
  bool unit_stated = true;  // false: to be inferred
};

struct InventoryColumns {
  std::map<InventoryField, InventoryColumn> of;
  std::vector<std::string> unknown;  // names nobody uses
  bool counts_trees = false;         // iLand: no id column, trees are counted

  const InventoryColumn* find(InventoryField field) const {
    const auto found = of.find(field);
    return found == of.end() ? nullptr : &found->second;
  }
};

// Adds a problem for two columns of one meaning and for every column that is missing.
InventoryColumns inventory_columns(const CsvTable& table, std::vector<InventoryProblem>& problems);

// Infers units that names do not state, and finds columns whose values cannot be in the unit they state (off
// by a factor of 10, 100 or 1000): one problem for the column. Returns the fields that have one.
std::vector<InventoryField> settle_units(const CsvTable& table, InventoryColumns& columns,
                                         std::vector<InventoryProblem>& problems);

}  // namespace sunfleck
