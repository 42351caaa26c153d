#include "lighting/sky/radiation_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <tuple>

#include "lighting/sky/utc_time.h"
#include "sim/base/error.h"
#include "sim/forest/csv_table.h"

namespace sunfleck {
namespace {

struct Unit {
  const char* name;
  double in_si;
  bool is_power;
};
constexpr std::array<Unit, 6> kUnits = {{{"mj_m2", 1e6, false},
                                         {"kj_m2", 1e3, false},
                                         {"j_m2", 1.0, false},
                                         {"kwh_m2", 3.6e6, false},
                                         {"wh_m2", 3600.0, false},
                                         {"w_m2", 1.0, true}}};

struct Column {
  std::size_t index;
  Unit unit;
};

std::string all_columns(const std::string& stem) {
  std::string text;
  for (const Unit& unit : kUnits) text += (text.empty() ? "" : ", ") + stem + unit.name;
  return text;
}

// The one column that begins with `stem` and ends in a known unit.
std::optional<Column> find_column(const CsvTable& csv, const std::string& stem, const std::string& name) {
  std::optional<Column> found;
  for (const Unit& unit : kUnits) {
    const auto index = csv.column(stem + unit.name);
    if (!index) continue;
    if (found)
      throw_invalid(name + ", column " + stem + unit.name,
                    "the table has " + stem + found->unit.name + " as well",
                    "one column of " + stem + "<unit>");
    found = Column{*index, unit};
  }
  return found;
}

struct Layout {
  RadiationPer per;
  std::size_t key;
  std::optional<std::size_t> year;
  Column global;
  std::optional<std::size_t> fraction;
  std::optional<Column> diffuse;
};

Layout layout_of(const CsvTable& csv, const std::string& name) {
  Layout layout{};
  int keys = 0;
  for (const auto& [column, per] : {std::pair{"month", RadiationPer::kMonth},
                                    {"date", RadiationPer::kDay},
                                    {"time", RadiationPer::kTime}}) {
    if (const auto index = csv.column(column)) {
      layout.per = per;
      layout.key = *index;
      ++keys;
    }
  }
  if (keys != 1)
    throw_invalid(
        name,
        keys == 0 ? "the table does not say when its rows are" : "the table says twice when its rows are",
        "one of the columns month, date and time");
  layout.year = csv.column("year");
  const auto global = find_column(csv, "global_horizontal_", name);
  if (!global)
    throw_invalid(name + ", column global_horizontal_<unit>", "the column is missing",
                  "one of " + all_columns("global_horizontal_"));
  layout.global = *global;
  layout.fraction = csv.column("diffuse_fraction");
  layout.diffuse = find_column(csv, "diffuse_horizontal_", name);
  if (layout.fraction && layout.diffuse)
    throw_invalid(name + ", column diffuse_fraction", "the table has diffuse radiation as well",
                  "one of the two");
  return layout;
}

double read_radiation_value(const CsvTable& csv, std::size_t row, const Column& column) {
  return csv.number(row, column.index, 0.0, 1e15, std::string("a radiation >= 0 in ") + column.unit.name) *
         column.unit.in_si;
}

std::optional<double> read_diffuse_fraction(const CsvTable& csv, std::size_t row, const Layout& layout,
                                            double global) {
  if (layout.fraction)
    return csv.number(row, *layout.fraction, 0.0, 1.0, "a share from 0 to 1 (71 % is 0.71)");
  if (!layout.diffuse) return std::nullopt;
  const double diffuse = read_radiation_value(csv, row, *layout.diffuse);
  if (layout.diffuse->unit.is_power != layout.global.unit.is_power)
    throw_invalid(csv.where(row, layout.diffuse->index), "is in another kind of unit than global radiation",
                  "both as energy, or both as power");
  if (diffuse > global * (1.0 + 1e-9))
    throw_invalid(csv.where(row, layout.diffuse->index), "is more than the global radiation of its row",
                  "diffuse radiation on the horizontal, a part of the global");
  return global > 0.0 ? std::min(1.0, diffuse / global) : 1.0;
}

// When the row is; the end of a kTime row is set by the next one.
void read_key(const CsvTable& csv, std::size_t r, const Layout& layout, RadiationRow& row) {
  const std::string where = csv.where(r, layout.key);
  const std::string& text = csv.field(r, layout.key);
  switch (layout.per) {
    case RadiationPer::kMonth: {
      const double month = csv.number(r, layout.key, 1, 12, "a month from 1 to 12");
      if (month != std::floor(month))
        throw_invalid(where, text + " is no month", "a whole number from 1 to 12");
      row.month = static_cast<int>(month);
      if (layout.year)
        row.year = static_cast<int>(csv.number(r, *layout.year, 1900, 2100, "a year from 1900 to 2100"));
      return;
    }
    case RadiationPer::kDay:
      row.day = day_number(parse_date(text, where));
      return;
    case RadiationPer::kTime:
      row.begin_s = parse_zoned_time(text, where).utc_s;
      return;
  }
}

auto order_of(const RadiationRow& row) { return std::tuple(row.year, row.month, row.day, row.begin_s); }

void sort_rows(std::vector<RadiationRow>& rows) {
  std::stable_sort(rows.begin(), rows.end(),
                   [](const auto& a, const auto& b) { return order_of(a) < order_of(b); });
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (order_of(rows[i]) == order_of(rows[i - 1]))
      throw_invalid(rows[i].where, "there are two rows for this time", "one row for each month, day or time");
}

// Rows of a time table last as long as the closest two are apart.
void set_ends(std::vector<RadiationRow>& rows) {
  double step_s = rows.size() > 1 ? 1e30 : 3600.0;
  for (std::size_t i = 1; i < rows.size(); ++i)
    step_s = std::min(step_s, rows[i].begin_s - rows[i - 1].begin_s);
  if (step_s < 60.0 || step_s > 3 * 3600.0)
    throw_invalid(rows.front().where, "its rows are " + std::to_string(step_s / 60.0) + " minutes apart",
                  "rows 1 minute to 3 hours apart, or the column date for days");
  for (RadiationRow& row : rows) row.end_s = row.begin_s + step_s;
}

void complete(RadiationTable& table) {
  if (table.rows.empty())
    throw_invalid(table.name, "the table has no rows", "at least one month, day or time");
  sort_rows(table.rows);
  if (table.per == RadiationPer::kTime) set_ends(table.rows);
}

}  // namespace

RadiationTable parse_radiation(std::string_view text, const std::string& name) {
  const CsvTable csv(text, name);
  const Layout layout = layout_of(csv, name);
  RadiationTable table{
      name, layout.per, layout.global.unit.is_power, layout.global.unit.name, layout.global.unit.in_si, {}};
  for (std::size_t r = 0; r < csv.rows(); ++r) {
    RadiationRow row;
    row.where = csv.where(r, layout.global.index);
    read_key(csv, r, layout, row);
    row.global = read_radiation_value(csv, r, layout.global);
    row.diffuse_fraction = read_diffuse_fraction(csv, r, layout, row.global);
    table.rows.push_back(std::move(row));
  }
  complete(table);
  return table;
}

RadiationTable radiation_table(const std::string& name, RadiationPer per, bool is_power,
                               std::vector<RadiationRow> rows) {
  RadiationTable table{name, per, is_power, is_power ? "w_m2" : "j_m2", 1.0, std::move(rows)};
  complete(table);
  return table;
}

RadiationTable read_radiation(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in || !std::filesystem::is_regular_file(path))
    throw Error(ErrorKind::kNotFound, path.string(), "the radiation table cannot be opened", "a CSV file");
  std::ostringstream text;
  text << in.rdbuf();
  return parse_radiation(text.str(), path.string());
}

}  // namespace sunfleck
