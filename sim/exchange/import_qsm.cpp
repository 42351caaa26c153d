#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "sim/base/error.h"
#include "sim/exchange/qsm.h"
#include "sim/forest/csv_table.h"
#include "sim/plant/text_file.h"

namespace sunfleck {
namespace {

constexpr double kFarthest_m = 1e9, kLongest_m = 200, kThickest_m = 10, kMovedFrom_m = 1;
const char* const kWanted =
    "start_x, start_y, start_z, radius, and either end_x, end_y, end_z or axis_x, axis_y, axis_z, length";

// "Start X (m)", "startX" and "start_x_m" are one name: letters and digits without a unit.
std::string plain_name(const std::string& name) {
  std::string plain;
  for (const char c : name.substr(0, name.find_first_of("([")))
    if (std::isalnum(static_cast<unsigned char>(c)))
      plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const bool has_unit = name.size() > 2 && (name.ends_with("_m") || name.ends_with(".m"));
  return has_unit ? plain.substr(0, plain.size() - 1) : plain;
}

using Names = std::vector<std::string>;

std::optional<std::size_t> find_column(const CsvTable& table, const Names& names) {
  for (const std::string& name : names)
    for (std::size_t c = 0; c < table.columns(); ++c)
      if (plain_name(table.column_name(c)) == name) return c;
  return std::nullopt;
}

std::size_t required(const CsvTable& table, const Names& names) {
  if (const auto column = find_column(table, names)) return *column;
  throw_invalid(table.header_where(), "no column \"" + names.front() + "\" among: " + table.column_names(),
                std::string("give the columns ") + kWanted);
}

// The names of one coordinate (0 to 2) of `start`, `end` or `axis`.
Names coordinate_names(const std::string& of, int axis) {
  const std::string letter(1, "xyz"[axis]), digit(1, "123"[axis]);
  Names names = {of + letter, letter + of,           of + "point" + digit,     of + "direction" + digit,
                 of + digit,  of + "point" + letter, of + "direction" + letter};
  if (of == "start") names.push_back(letter);
  return names;
}

using Columns = std::array<std::size_t, 3>;
std::optional<Columns> find_point(const CsvTable& table, const std::string& of) {
  Columns columns{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto column = find_column(table, coordinate_names(of, axis));
    if (!column) return std::nullopt;
    columns[static_cast<std::size_t>(axis)] = *column;
  }
  return columns;
}

struct QsmColumns {
  Columns start{};
  std::optional<Columns> end, axis;
  std::size_t length = 0;  // with axis
  std::size_t radius_start = 0, radius_end = 0;
  std::optional<std::size_t> id, parent;
};

void find_radii(const CsvTable& table, QsmColumns& columns) {
  const auto from = find_column(table, {"radiusstart"}), to = find_column(table, {"radiusend"});
  if (from && to) {
    columns.radius_start = *from;
    columns.radius_end = *to;
  } else {
    columns.radius_start = columns.radius_end = required(table, {"radius", "radiuscyl", "r"});
  }
}

QsmColumns find_columns(const CsvTable& table) {
  QsmColumns columns;
  for (int axis = 0; axis < 3; ++axis)
    columns.start[static_cast<std::size_t>(axis)] = required(table, coordinate_names("start", axis));
  columns.end = find_point(table, "end");
  if (!columns.end) {
    columns.axis = find_point(table, "axis");
    if (!columns.axis) required(table, coordinate_names("end", 0));
    columns.length = required(table, {"length", "len"});
  }
  find_radii(table, columns);
  columns.id = find_column(table, {"id", "cylid", "cylinderid"});
  columns.parent = find_column(table, {"parent", "parentid"});
  return columns;
}

struct Cylinder {
  Vec3 start_m, end_m;
  double radius_start_m, radius_end_m;
  std::int64_t id, parent;  // parent <= 0: none
  std::size_t row;
};

Vec3 point_at(const CsvTable& table, std::size_t row, const Columns& c, double most,
              const std::string& expected) {
  return {table.number(row, c[0], -most, most, expected), table.number(row, c[1], -most, most, expected),
          table.number(row, c[2], -most, most, expected)};
}

Vec3 end_of(const CsvTable& table, std::size_t row, const QsmColumns& c, const Vec3& start_m) {
  if (c.end) return point_at(table, row, *c.end, kFarthest_m, "metres");
  const Vec3 axis = point_at(table, row, *c.axis, 1e6, "a direction");
  const double length_m =
      table.number(row, c.length, 0, kLongest_m, "a length in metres, 0 to 200 (are these centimetres?)");
  const double size = glm::length(axis);
  return size > 0.0 ? start_m + length_m / size * axis : start_m;
}

Cylinder cylinder_at(const CsvTable& table, std::size_t row, const QsmColumns& c) {
  const char* radius = "a radius in metres, 0 to 10 (are these millimetres or centimetres?)";
  Cylinder cylinder{};
  cylinder.row = row;
  cylinder.start_m = point_at(table, row, c.start, kFarthest_m, "metres");
  cylinder.end_m = end_of(table, row, c, cylinder.start_m);
  cylinder.radius_start_m = table.number(row, c.radius_start, 0, kThickest_m, radius);
  cylinder.radius_end_m = table.number(row, c.radius_end, 0, kThickest_m, radius);
  const char* number = "a cylinder number";
  cylinder.id = c.id ? static_cast<std::int64_t>(table.number(row, *c.id, -1, 1e15, number))
                     : static_cast<std::int64_t>(row) + 1;
  cylinder.parent = c.parent ? static_cast<std::int64_t>(table.number(row, *c.parent, -1, 1e15, number)) : 0;
  if (glm::distance(cylinder.start_m, cylinder.end_m) > kLongest_m)
    throw_invalid(table.where(row), "a cylinder longer than 200 m", "give metres");
  return cylinder;
}

// Some programs count cylinders from 0 and give the root the parent -1, others from 1 and 0.
void check_parents(const CsvTable& table, const std::vector<Cylinder>& cylinders) {
  std::set<std::int64_t> ids;
  for (const Cylinder& c : cylinders)
    if (!ids.insert(c.id).second)
      throw_invalid(table.where(c.row), "cylinder " + std::to_string(c.id) + " is there twice",
                    "number the cylinders of one tree; give one tree per file");
  for (const Cylinder& c : cylinders)
    if (c.parent > 0 && !ids.contains(c.parent))
      throw_invalid(table.where(c.row), "its parent " + std::to_string(c.parent) + " is no cylinder",
                    "give the number of another row, or 0 for none");
}

Vec3 foot_of(const std::vector<Cylinder>& cylinders, bool has_parents) {
  Vec3 foot_m(0, 0, std::numeric_limits<double>::infinity());
  for (const Cylinder& c : cylinders)
    if ((!has_parents || c.parent <= 0) && c.start_m.z < foot_m.z) foot_m = c.start_m;
  return foot_m;
}

std::string metres(const Vec3& p) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.3f, %.3f, %.3f) m", p.x, p.y, p.z);
  return text;
}

void settle_place(std::vector<Cylinder>& cylinders, bool has_parents, QsmReport& report) {
  const Vec3 foot_m = foot_of(cylinders, has_parents);
  if (!is_finite(foot_m) || glm::length(foot_m) <= kMovedFrom_m) return;
  report.moved_m = -foot_m;
  report.warnings.push_back("moved so that the stem foot at " + metres(foot_m) + " comes to the origin");
  for (Cylinder& c : cylinders) {
    c.start_m -= foot_m;
    c.end_m -= foot_m;
  }
}

std::vector<Cylinder> read_cylinders(const CsvTable& table, const QsmColumns& columns, QsmReport& report) {
  std::vector<Cylinder> cylinders;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    cylinders.push_back(cylinder_at(table, row, columns));
    const Cylinder& c = cylinders.back();
    if (c.start_m == c.end_m || std::max(c.radius_start_m, c.radius_end_m) == 0.0)
      ++report.degenerate_skipped;
  }
  check_parents(table, cylinders);
  return cylinders;
}

}  // namespace

Prototype import_qsm(const std::filesystem::path& path, const std::string& material, QsmReport* report) {
  if (material.empty()) throw_invalid("material", "is empty", "name the species of the tree");
  const std::string text = read_text_file(path);
  const CsvTable table(text, path.string());
  const QsmColumns columns = find_columns(table);
  QsmReport found;
  std::vector<Cylinder> cylinders = read_cylinders(table, columns, found);
  settle_place(cylinders, columns.parent.has_value(), found);
  Prototype tree;
  tree.name = path.filename().string();
  tree.materials = {material};
  for (const Cylinder& c : cylinders)
    if (c.start_m != c.end_m && std::max(c.radius_start_m, c.radius_end_m) > 0.0)
      tree.wood.push_back({Vec3f(c.start_m), Vec3f(c.end_m), static_cast<float>(c.radius_start_m),
                           static_cast<float>(c.radius_end_m), 0});
  found.cylinders = tree.wood.size();
  if (tree.wood.empty())
    throw_invalid(path.string(), "holds no cylinder", std::string("give the columns ") + kWanted);
  if (found.degenerate_skipped > 0)
    found.warnings.push_back(std::to_string(found.degenerate_skipped) +
                             " cylinders without length or radius were left out");
  if (report) *report = std::move(found);
  return tree;
}

}  // namespace sunfleck
