// Stand inventories as people have them: which columns mean what, in which units, and everything that is
// wrong with a table, listed before anything runs.
//
// Columns, in any order, case and separator (comma, semicolon, tab); the first name is ours:
//   id_tree | id | tree_id | tree          whole number, own to each tree
//   species | sp | species_code            a name of the species library
//   x | x_m | east, y | y_m | north        metres in the plane; or lon, lat in degrees (WGS84), turned into
//                                          metres east and north of their mean
//   dbh_cm | dbh | dbh_m | dbh_mm          stem diameter at 1.3 m
//   h_m | height | height_m | h | h_cm     and, where known, hbase_m | crown_base_m | hcb_m, hmax_m,
//   rn_m rs_m re_m rw_m | crown_radius_m   crown radii; crown_lad; crown_type (E, 2E, 4E, 8E)
// A name that ends in _m, _cm or _mm states its unit; of a bare `dbh` or `height` the unit is inferred from
// the values, with a warning. iLand's tree list (x;y;species;dbh;height;age) has no numbers for its trees:
// they are counted from 1. Empty fields and NA are not measured. Columns nobody knows are named in a warning.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sim/forest/forest_spec.h"
#include "sim/plant/species.h"

namespace sunfleck {

enum class Severity { kWarning, kError };

struct InventoryProblem {
  Severity severity = Severity::kError;
  std::string where;  // "file:line, column x", "file:line" or "file"
  std::string what, remedy;
};

struct InventoryReading {
  std::vector<InventoryTree> trees;        // rows without an error
  std::vector<InventoryProblem> problems;  // in the order of the rows; warnings for the whole table last
  std::size_t rows = 0;
  bool has_errors() const;
};

// Lists every problem; throws only for a file that cannot be read.
// `form`: of rows that state none.
InventoryReading examine_inventory(std::string_view csv, const std::string& name,
                                   TreeForm form = TreeForm::kStandGrown);
InventoryReading examine_inventory(const std::filesystem::path& path);

// The same and what only the species library knows: species without a file, heights and crowns far from what
// trees of that diameter have.
InventoryReading check_inventory(const std::filesystem::path& path, const SpeciesLibrary& species);

}  // namespace sunfleck
