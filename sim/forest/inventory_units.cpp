// Units by their values. A column's median decides: inventories mix seedlings and giants, but half of a stand
// is never outside these spans.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>

#include "sim/forest/inventory_columns.h"

namespace sunfleck {
namespace {

using F = InventoryField;

// Where the median of a measure lies, in our unit (cm for the DBH, m, m2/m3); a table's own unit is one of
// `units`, our unit first.
struct Unit {
  const char* name;
  double in_ours;
};
struct Plausible {
  InventoryField field;
  double lo, hi;
  std::array<Unit, 3> units;
};
constexpr std::array<Unit, 3> kDbhUnits{{{"centimetres", 1}, {"metres", 100}, {"millimetres", 0.1}}};
constexpr std::array<Unit, 3> kLengthUnits{{{"metres", 1}, {"centimetres", 0.01}, {"decimetres", 0.1}}};
constexpr std::array kPlausible = std::to_array<Plausible>({
    {F::kDbh, 1.5, 250, kDbhUnits},
    {F::kHeight, 1.3, 90, kLengthUnits},
    {F::kCrownBase, 0.02, 70, kLengthUnits},
    {F::kWidest, 0.3, 80, kLengthUnits},
    {F::kRadiusNorth, 0.1, 20, kLengthUnits},
    {F::kRadiusSouth, 0.1, 20, kLengthUnits},
    {F::kRadiusEast, 0.1, 20, kLengthUnits},
    {F::kRadiusWest, 0.1, 20, kLengthUnits},
    {F::kRadius, 0.1, 20, kLengthUnits},
});

std::optional<double> median_of(const CsvTable& table, std::size_t column) {
  std::vector<double> values;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string& text = table.field(row, column);
    double value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code == std::errc() && end == text.data() + text.size() && std::isfinite(value) && value > 0)
      values.push_back(value);
  }
  if (values.empty()) return std::nullopt;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

std::string short_number(double value) {
  std::ostringstream out;
  out.precision(3);
  out << value;
  return out.str();
}

bool fits(const Plausible& p, double median) { return median >= p.lo && median <= p.hi; }

const Unit* unit_that_fits(const Plausible& p, double median) {
  for (const Unit& unit : p.units)
    if (fits(p, median * unit.in_ours)) return &unit;
  return nullptr;
}

// A name without unit takes the first unit that fits, and says so.
void infer(const CsvTable& table, const Plausible& p, InventoryColumn& column, double median,
           std::vector<InventoryProblem>& problems) {
  const Unit* unit = unit_that_fits(p, median);
  if (unit == nullptr) return;
  column.factor = unit->in_ours;
  const std::string name = table.column_name(column.index);
  problems.push_back({Severity::kWarning, table.header_where() + ", column " + name,
                      "taken as " + std::string(unit->name) + " (the median is " + short_number(median) + ")",
                      "name the column with its unit, " + name + (p.field == F::kDbh ? "_cm" : "_m") +
                          ", if that is wrong"});
}

}  // namespace

std::vector<InventoryField> settle_units(const CsvTable& table, InventoryColumns& columns,
                                         std::vector<InventoryProblem>& problems) {
  std::vector<InventoryField> wrong;
  constexpr std::size_t kFewRows = 5;  // a handful of seedlings is no proof
  for (const Plausible& p : kPlausible) {
    const auto found = columns.of.find(p.field);
    if (found == columns.of.end()) continue;
    InventoryColumn& column = found->second;
    const auto median = median_of(table, column.index);
    if (!median) continue;
    if (!column.unit_stated) infer(table, p, column, *median, problems);
    if (table.rows() < kFewRows || fits(p, *median * column.factor)) continue;
    const Unit* unit = unit_that_fits(p, *median);
    if (unit == nullptr) continue;  // not a matter of units: the rows say what is wrong
    problems.push_back(
        {Severity::kError, table.header_where() + ", column " + table.column_name(column.index),
         "the values look like " + std::string(unit->name) + " (the median is " + short_number(*median) + ")",
         "name the column with its unit, or give the unit that its name states"});
    wrong.push_back(p.field);
  }
  return wrong;
}

}  // namespace sunfleck
