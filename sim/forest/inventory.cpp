// Reads the columns of a stand inventory. Crown type: the eight-eighths ellipsoid (8E) and its special cases
// are what crown shapes can be; others are refused.
#include "sim/forest/inventory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>

#include "sim/base/error.h"
#include "sim/forest/inventory_columns.h"
#include "sim/forest/plane_coordinates.h"

namespace sunfleck {

namespace {

using F = InventoryField;
using Measure = std::optional<double> InventoryTree::*;

// Optional columns, their least and greatest values in metres (m2/m3), and what they are.
struct MeasureColumn {
  InventoryField field;
  std::vector<Measure> members;
  double lo, hi;
  const char* expected;
};
constexpr double kTallestM = 150, kWidestM = 100, kFarthestM = 1e7;
const std::vector<MeasureColumn>& measures() {
  using T = InventoryTree;
  static const std::vector<MeasureColumn> table{
      {F::kHeight, {&T::height_m}, 0.01, kTallestM, "the tree's height in metres, 0.01 to 150"},
      {F::kCrownBase, {&T::crown_base_m}, 0, kTallestM, "the crown base's height in metres, 0 to 150"},
      {F::kWidest, {&T::widest_m}, 0, kTallestM, "the height of the largest radius, 0 to 150 m"},
      {F::kRadius,
       {&T::radius_n_m, &T::radius_s_m, &T::radius_e_m, &T::radius_w_m},
       0,
       kWidestM,
       "the crown radius, 0 to 100 m"},
      {F::kRadiusNorth, {&T::radius_n_m}, 0, kWidestM, "the crown radius towards north, 0 to 100 m"},
      {F::kRadiusSouth, {&T::radius_s_m}, 0, kWidestM, "the crown radius towards south, 0 to 100 m"},
      {F::kRadiusEast, {&T::radius_e_m}, 0, kWidestM, "the crown radius towards east, 0 to 100 m"},
      {F::kRadiusWest, {&T::radius_w_m}, 0, kWidestM, "the crown radius towards west, 0 to 100 m"},
      {F::kLeafAreaDensity, {&T::leaf_area_density_per_m}, 0, 100, "leaf area density in m2/m3, 0 to 100"},
  };
  return table;
}

bool is_missing(const std::string& field) { return field.empty() || field == "NA"; }

// Reads row by row; what is wrong goes to the list, and a row with an error gives no tree.
class RowReader {
 public:
  RowReader(const CsvTable& table, const InventoryColumns& columns, std::vector<InventoryField> unread,
            TreeForm usual_form, std::vector<InventoryProblem>& problems)
      : table_(table),
        columns_(columns),
        unread_(std::move(unread)),
        usual_form_(usual_form),
        problems_(problems) {}

  std::optional<InventoryTree> read(std::size_t row);

 private:
  void complain(const std::string& where, const std::string& what, const std::string& remedy) {
    problems_.push_back({Severity::kError, where, what, remedy});
    good_ = false;
  }
  std::string where(std::size_t row, InventoryField field) const {
    return table_.where(row, columns_.find(field)->index);
  }
  const std::string& text(std::size_t row, InventoryField field) const {
    return table_.field(row, columns_.find(field)->index);
  }
  bool is_read(InventoryField field) const {
    return columns_.find(field) != nullptr &&
           std::find(unread_.begin(), unread_.end(), field) == unread_.end();
  }
  std::optional<double> number(std::size_t row, InventoryField field, double lo, double hi,
                               const std::string& expected);
  std::optional<TreeId> id(std::size_t row);
  void read_place(std::size_t row, InventoryTree& tree);
  void read_measures(std::size_t row, InventoryTree& tree);
  void require_order(std::size_t row, InventoryField lower_field, std::optional<double> lower,
                     InventoryField upper_field, std::optional<double> upper);
  void check_heights(std::size_t row, const InventoryTree& tree);
  void check_crown_type(std::size_t row);
  TreeForm form(std::size_t row);

  const CsvTable& table_;
  const InventoryColumns& columns_;
  const std::vector<InventoryField> unread_;
  const TreeForm usual_form_;
  std::vector<InventoryProblem>& problems_;
  std::map<TreeId, std::string> place_of_id_;
  bool good_ = true;
};

std::optional<double> RowReader::number(std::size_t row, InventoryField field, double lo, double hi,
                                        const std::string& expected) try {
  const InventoryColumn& column = *columns_.find(field);
  return column.factor * table_.number(row, column.index, lo / column.factor, hi / column.factor, expected);
} catch (const Error& error) {
  complain(error.where(), error.problem(), error.remedy());
  return std::nullopt;
}

std::optional<TreeId> RowReader::id(std::size_t row) {
  if (columns_.counts_trees) return TreeId{static_cast<std::uint32_t>(row + 1)};
  const auto value = number(row, F::kId, 0, kLargestTreeNumber, "a whole number from 0 to 2147483647");
  if (!value) return std::nullopt;
  const TreeId tree{static_cast<std::uint32_t>(*value)};
  if (*value != static_cast<double>(tree.value)) {
    complain(where(row, F::kId), text(row, F::kId) + " is no whole number",
             "give each tree its own whole number");
    return std::nullopt;
  }
  const auto [first, is_new] = place_of_id_.emplace(tree, where(row, F::kId));
  if (!is_new)
    complain(where(row, F::kId), "tree " + text(row, F::kId) + " was there before, at " + first->second,
             "give each tree its own number");
  return tree;
}

void RowReader::read_place(std::size_t row, InventoryTree& tree) {
  const bool degrees = columns_.find(F::kLongitude) != nullptr;
  const auto x = degrees ? number(row, F::kLongitude, -180, 180, "degrees east, -180 to 180")
                         : number(row, F::kX, -kFarthestM, kFarthestM, "metres east, within 10,000 km");
  const auto y = degrees ? number(row, F::kLatitude, -89, 89, "degrees north, -89 to 89")
                         : number(row, F::kY, -kFarthestM, kFarthestM, "metres north, within 10,000 km");
  tree.x_m = x.value_or(0);
  tree.y_m = y.value_or(0);
}

void RowReader::read_measures(std::size_t row, InventoryTree& tree) {
  for (const MeasureColumn& measure : measures()) {
    if (!is_read(measure.field) || is_missing(text(row, measure.field))) continue;
    const auto value = number(row, measure.field, measure.lo, measure.hi, measure.expected);
    for (const Measure member : measure.members) tree.*member = value;
  }
}

// A height that must not be under another one; both may be unknown.
void RowReader::require_order(std::size_t row, InventoryField lower_field, std::optional<double> lower,
                              InventoryField upper_field, std::optional<double> upper) {
  if (!lower || !upper || *lower <= *upper) return;
  complain(where(row, lower_field),
           table_.column_name(columns_.find(lower_field)->index) + " is above " +
               table_.column_name(columns_.find(upper_field)->index),
           "heights must be hbase_m <= hmax_m <= h_m");
}

void RowReader::check_heights(std::size_t row, const InventoryTree& tree) {
  require_order(row, F::kCrownBase, tree.crown_base_m, F::kHeight, tree.height_m);
  require_order(row, F::kCrownBase, tree.crown_base_m, F::kWidest, tree.widest_m);
  require_order(row, F::kWidest, tree.widest_m, F::kHeight, tree.height_m);
  if (tree.crown_base_m && tree.height_m && *tree.crown_base_m == *tree.height_m)
    complain(where(row, F::kCrownBase), "the crown base is at the top", "a crown base below h_m");
}

void RowReader::check_crown_type(std::size_t row) {
  if (columns_.find(F::kCrownType) == nullptr) return;
  const std::string& type = text(row, F::kCrownType);
  for (const char* known : {"E", "2E", "4E", "8E"})
    if (type == known) return;
  if (is_missing(type)) return;
  complain(where(row, F::kCrownType), "crown type " + type + " is not supported",
           "E, 2E, 4E or 8E (ellipsoid parts), or leave it empty");
}

TreeForm RowReader::form(std::size_t row) {
  if (columns_.find(F::kForm) == nullptr || is_missing(text(row, F::kForm))) return usual_form_;
  for (const TreeForm form : {TreeForm::kStandGrown, TreeForm::kOpenGrown})
    if (text(row, F::kForm) == to_string(form)) return form;
  complain(where(row, F::kForm), "form " + text(row, F::kForm) + " is unknown",
           "stand or open: how the tree grew up, or leave it empty");
  return usual_form_;
}

std::optional<InventoryTree> RowReader::read(std::size_t row) {
  good_ = true;
  InventoryTree tree;
  tree.id = id(row).value_or(TreeId{});
  tree.species = text(row, F::kSpecies);
  if (is_missing(tree.species)) complain(where(row, F::kSpecies), "the species is missing", "name it");
  read_place(row, tree);
  if (is_read(F::kDbh))
    tree.dbh_cm = number(row, F::kDbh, 0.1, 1000, "a stem diameter from 0.1 to 1000 cm").value_or(0);
  read_measures(row, tree);
  tree.where = table_.where(row);
  check_heights(row, tree);
  check_crown_type(row);
  tree.form = form(row);
  return good_ ? std::optional(tree) : std::nullopt;
}

void warn_of_shared_places(const std::vector<InventoryTree>& trees, const std::string& name,
                           std::vector<InventoryProblem>& problems) {
  std::map<std::pair<double, double>, const InventoryTree*> at;
  std::size_t places = 0;
  for (const InventoryTree& tree : trees) {
    const auto [first, is_new] = at.emplace(std::pair(tree.x_m, tree.y_m), &tree);
    places += is_new ? 1 : 0;
    if (is_new || trees.size() < 2) continue;
    problems.push_back({Severity::kWarning, tree.where,
                        "tree " + std::to_string(tree.id.value) + " stands at the very place of tree " +
                            std::to_string(first->second->id.value),
                        "right for stems of one coppice; else correct x and y"});
  }
  if (trees.size() > 2 && places == 1)
    problems.push_back(
        {Severity::kError, name, "all trees stand at one point", "give each tree its own x and y"});
}

void add_trees(const CsvTable& table, const InventoryColumns& columns, std::vector<InventoryField> unread,
               TreeForm form, const std::string& name, InventoryReading& reading) {
  RowReader reader(table, columns, std::move(unread), form, reading.problems);
  for (std::size_t row = 0; row < table.rows(); ++row)
    if (auto tree = reader.read(row)) reading.trees.push_back(std::move(*tree));
  if (columns.find(F::kLongitude) != nullptr && !reading.trees.empty()) {
    const std::string said = to_plane_coordinates(reading.trees);
    reading.problems.push_back(
        {Severity::kWarning, name, said, "add x and y to the table to choose another origin"});
  }
  warn_of_shared_places(reading.trees, name, reading.problems);
}

std::string content_of(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) {
    throw Error(ErrorKind::kNotFound, path.string(), "there is no such file", "give an inventory as CSV");
  }
  if (std::filesystem::is_directory(path))
    throw_invalid(path.string(), "is a folder, not a file", "give the path of a CSV file");
  if (!std::filesystem::is_regular_file(path))
    throw_invalid(path.string(), "this is not a file", "give a CSV file");
  std::ifstream in(path, std::ios::binary);
  std::string csv{std::istreambuf_iterator<char>(in), {}};
  if (!in.good() && !in.eof()) {
    throw Error(ErrorKind::kInputOutput, path.string(), "the file cannot be read", "check its permissions");
  }
  return csv;
}

}  // namespace

bool InventoryReading::has_errors() const {
  return std::any_of(problems.begin(), problems.end(),
                     [](const InventoryProblem& p) { return p.severity == Severity::kError; });
}

InventoryReading examine_inventory(std::string_view csv, const std::string& name, TreeForm form) try {
  InventoryReading reading;
  std::vector<Error> bad_rows;
  const CsvTable table(csv, name, &bad_rows);
  for (const Error& bad : bad_rows)
    reading.problems.push_back({Severity::kError, bad.where(), bad.problem(), bad.remedy()});
  reading.rows = table.rows() + bad_rows.size();
  InventoryColumns columns = inventory_columns(table, reading.problems);
  if (reading.rows == 0)
    reading.problems.push_back(
        {Severity::kError, name, "the inventory has no trees", "one row per tree below the header"});
  const bool readable = std::none_of(reading.problems.begin(), reading.problems.end(), [&](const auto& p) {
    return p.severity == Severity::kError && p.where.rfind(table.header_where() + ", column", 0) == 0;
  });
  if (!readable || table.rows() == 0) return reading;
  const std::vector<InventoryField> unread = settle_units(table, columns, reading.problems);
  add_trees(table, columns, unread, form, name, reading);
  return reading;
} catch (const Error& error) {  // no header to speak of
  return {{}, {{Severity::kError, error.where(), error.problem(), error.remedy()}}, 0};
}

InventoryReading examine_inventory(const std::filesystem::path& path) {
  return examine_inventory(content_of(path), path.string());
}

std::vector<InventoryTree> parse_inventory(std::string_view csv, const std::string& name, TreeForm form) {
  InventoryReading reading = examine_inventory(csv, name, form);
  for (const InventoryProblem& problem : reading.problems)
    if (problem.severity == Severity::kError) throw_invalid(problem.where, problem.what, problem.remedy);
  return std::move(reading.trees);
}

std::vector<InventoryTree> read_inventory(const std::filesystem::path& path, TreeForm form) {
  return parse_inventory(content_of(path), path.string(), form);
}

}  // namespace sunfleck
