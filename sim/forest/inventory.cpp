// Reads the columns of a stand inventory; a value that is empty or NA counts as not measured. Crown type: the
// eight-eighths ellipsoid (8E) and its special cases are what crown shapes can be; others are refused.

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <map>

#include "sim/base/error.h"
#include "sim/forest/csv_table.h"
#include "sim/forest/forest_spec.h"

namespace sunfleck {

namespace {

using Measure = std::optional<double> InventoryTree::*;

// Optional columns, their least and greatest values, and what they are.
struct MeasureColumn {
  const char* name;
  Measure member;
  double lo, hi;
  const char* expected;
};
constexpr double kTallestM = 150, kWidestM = 100, kFarthestM = 1e7;
constexpr std::array<MeasureColumn, 8> kMeasures{{
    {"h_m", &InventoryTree::height_m, 0.01, kTallestM, "the tree's height in metres, 0.01 to 150"},
    {"hbase_m", &InventoryTree::crown_base_m, 0, kTallestM, "the crown base's height in metres, 0 to 150"},
    {"hmax_m", &InventoryTree::widest_m, 0, kTallestM, "the height of the largest radius, 0 to 150 m"},
    {"rn_m", &InventoryTree::radius_n_m, 0, kWidestM, "the crown radius towards north, 0 to 100 m"},
    {"rs_m", &InventoryTree::radius_s_m, 0, kWidestM, "the crown radius towards south, 0 to 100 m"},
    {"re_m", &InventoryTree::radius_e_m, 0, kWidestM, "the crown radius towards east, 0 to 100 m"},
    {"rw_m", &InventoryTree::radius_w_m, 0, kWidestM, "the crown radius towards west, 0 to 100 m"},
    {"crown_lad", &InventoryTree::leaf_area_density_per_m, 0, 100, "leaf area density in m2/m3, 0 to 100"},
}};

bool is_missing(const std::string& field) { return field.empty() || field == "NA"; }

TreeId tree_id(const CsvTable& table, std::size_t row, std::size_t column) {
  const double id = table.number(row, column, 0, 4294967295.0, "a whole number from 0 to 4294967295");
  if (id != static_cast<double>(static_cast<std::uint32_t>(id))) {
    throw_invalid(table.where(row, column), table.field(row, column) + " is no whole number",
                  "give each tree its own whole number");
  }
  return {static_cast<std::uint32_t>(id)};
}

// A height that must not be under another one; both may be unknown.
void require_order(const CsvTable& table, std::size_t row, const char* lower_name,
                   std::optional<double> lower, const char* upper_name, std::optional<double> upper) {
  if (!lower || !upper || *lower <= *upper) return;
  throw_invalid(table.where(row, table.required_column(lower_name)),
                std::string(lower_name) + " is above " + upper_name,
                "heights must be hbase_m <= hmax_m <= h_m");
}

void check_heights(const CsvTable& table, std::size_t row, const InventoryTree& tree) {
  require_order(table, row, "hbase_m", tree.crown_base_m, "h_m", tree.height_m);
  require_order(table, row, "hbase_m", tree.crown_base_m, "hmax_m", tree.widest_m);
  require_order(table, row, "hmax_m", tree.widest_m, "h_m", tree.height_m);
  if (tree.crown_base_m && tree.height_m && *tree.crown_base_m >= *tree.height_m) {
    throw_invalid(table.where(row, table.required_column("hbase_m")), "the crown base is at the top",
                  "a crown base below h_m");
  }
}

void check_crown_type(const CsvTable& table, std::size_t row) {
  const auto column = table.column("crown_type");
  if (!column) return;
  const std::string& type = table.field(row, *column);
  for (const char* known : {"E", "2E", "4E", "8E"}) {
    if (type == known) return;
  }
  if (is_missing(type)) return;
  throw_invalid(table.where(row, *column), "crown type " + type + " is not supported",
                "E, 2E, 4E or 8E (ellipsoid parts), or leave it empty");
}

InventoryTree tree_of_row(const CsvTable& table, std::size_t row) {
  InventoryTree tree;
  const auto number = [&](const char* name, double lo, double hi, const char* expected) {
    return table.number(row, table.required_column(name), lo, hi, expected);
  };
  tree.id = tree_id(table, row, table.required_column("id_tree"));
  tree.species = table.field(row, table.required_column("species"));
  if (is_missing(tree.species)) {
    throw_invalid(table.where(row, table.required_column("species")), "the species is missing", "name it");
  }
  tree.x_m = number("x", -kFarthestM, kFarthestM, "metres east, within 10,000 km");
  tree.y_m = number("y", -kFarthestM, kFarthestM, "metres north, within 10,000 km");
  tree.dbh_cm = number("dbh_cm", 0.1, 1000, "a stem diameter from 0.1 to 1000 cm");
  for (const MeasureColumn& measure : kMeasures) {
    const auto column = table.column(measure.name);
    if (!column || is_missing(table.field(row, *column))) continue;
    tree.*measure.member = table.number(row, *column, measure.lo, measure.hi, measure.expected);
  }
  tree.where = table.where(row);
  check_heights(table, row, tree);
  check_crown_type(table, row);
  return tree;
}

}  // namespace

std::vector<InventoryTree> parse_inventory(std::string_view csv, const std::string& name) {
  const CsvTable table(csv, name);
  for (const char* required : {"id_tree", "species", "x", "y", "dbh_cm"}) table.required_column(required);
  if (table.rows() == 0)
    throw_invalid(name, "the inventory has no trees", "one row per tree below the header");
  const std::size_t id_column = table.required_column("id_tree");
  std::vector<InventoryTree> trees;
  std::map<TreeId, std::size_t> row_of_id;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    trees.push_back(tree_of_row(table, row));
    const auto [first, is_new] = row_of_id.emplace(trees.back().id, row);
    if (is_new) continue;
    throw_invalid(table.where(row, id_column),
                  "tree " + table.field(row, id_column) + " was there before, at " +
                      table.where(first->second, id_column),
                  "give each tree its own number");
  }
  return trees;
}

std::vector<InventoryTree> read_inventory(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) {
    throw Error(ErrorKind::kNotFound, path.string(), "there is no such file", "give an inventory as CSV");
  }
  if (std::filesystem::is_directory(path))
    throw_invalid(path.string(), "is a folder, not a file", "give the path of a CSV file");
  if (!std::filesystem::is_regular_file(path))
    throw_invalid(path.string(), "this is not a file", "give a CSV file");
  std::ifstream in(path, std::ios::binary);
  const std::string csv{std::istreambuf_iterator<char>(in), {}};
  if (!in.good() && !in.eof()) {
    throw Error(ErrorKind::kInputOutput, path.string(), "the file cannot be read", "check its permissions");
  }
  return parse_inventory(csv, path.string());
}

}  // namespace sunfleck
