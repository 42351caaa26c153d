// One column per member of the structs; ids and small integers as 32-bit integers (same bits).

#include "sim/grid/forest_tables.h"

#include <stdexcept>

#include "sim/base/contract.h"

namespace sunfleck {

namespace {

// values[i] = member(rows[i])
template <class Row, class Member>
PointColumn column(const char* name, const std::vector<Row>& rows, Member member) {
  std::vector<decltype(member(rows.front()))> values;
  values.reserve(rows.size());
  for (const Row& row : rows) values.push_back(member(row));
  return {name, std::move(values)};
}

template <class Row, class Place>
std::vector<Vec3> places(const std::vector<Row>& rows, Place place) {
  std::vector<Vec3> positions_m;
  positions_m.reserve(rows.size());
  for (const Row& row : rows) positions_m.push_back(place(row));
  return positions_m;
}

template <class T>
const std::vector<T>& column_of(const PointTable& table, const std::string& name) {
  for (const PointColumn& candidate : table.columns) {
    if (candidate.name != name) continue;
    if (const auto* values = std::get_if<std::vector<T>>(&candidate.values)) return *values;
  }
  throw std::runtime_error("grid " + table.name + " lacks the attribute " + name);
}

// Calls set(row, value) for each row.
template <class T, class Row, class Set>
void read_column(const PointTable& table, const std::string& name, std::vector<Row>& rows, Set set) {
  const std::vector<T>& values = column_of<T>(table, name);
  if (rows.empty()) rows.resize(values.size());
  if (rows.size() != values.size()) throw std::runtime_error("grid " + table.name + " has uneven columns");
  for (std::size_t i = 0; i < rows.size(); ++i) set(rows[i], values[i]);
}

using Int = std::int32_t;

PointTable foliage_table(const Prototype& prototype, std::size_t index) {
  const auto& rows = prototype.foliage;
  using E = FoliageElement;
  for (const E& e : rows) SUNFLECK_EXPECTS(e.unused == 0);
  return {grid_name(kElementsGrid, index),
          "foliage elements of " + prototype.name,
          places(rows, [](const E& e) { return Vec3(e.centre_m); }),
          {column("centre", rows, [](const E& e) { return e.centre_m; }),
           column("half_u", rows, [](const E& e) { return e.half_u_m; }),
           column("half_v", rows, [](const E& e) { return e.half_v_m; }),
           column("area", rows, [](const E& e) { return e.area_m2; }),
           column("shape", rows, [](const E& e) { return static_cast<Int>(e.shape); }),
           column("material", rows, [](const E& e) { return static_cast<Int>(e.material); })}};
}

PointTable wood_table(const Prototype& prototype, std::size_t index) {
  const auto& rows = prototype.wood;
  using W = WoodSegment;
  return {grid_name(kWoodGrid, index),
          "wood segments of " + prototype.name,
          places(rows, [](const W& w) { return 0.5 * (Vec3(w.from_m) + Vec3(w.to_m)); }),
          {column("from", rows, [](const W& w) { return w.from_m; }),
           column("to", rows, [](const W& w) { return w.to_m; }),
           column("radius_from", rows, [](const W& w) { return w.radius_from_m; }),
           column("radius_to", rows, [](const W& w) { return w.radius_to_m; }),
           column("material", rows, [](const W& w) { return static_cast<Int>(w.material); })}};
}

PointTable wood_mesh_table(const Prototype& prototype, std::size_t index) {
  const auto& rows = prototype.wood_mesh;
  using T = WoodTriangle;
  return {grid_name(kWoodMeshGrid, index),
          "wood triangles of " + prototype.name,
          places(rows, [](const T& t) { return (Vec3(t.a_m) + Vec3(t.b_m) + Vec3(t.c_m)) / 3.0; }),
          {column("a", rows, [](const T& t) { return t.a_m; }),
           column("b", rows, [](const T& t) { return t.b_m; }),
           column("c", rows, [](const T& t) { return t.c_m; }),
           column("material", rows, [](const T& t) { return static_cast<Int>(t.material); })}};
}

PointTable instance_table(const std::vector<Instance>& rows) {
  using I = Instance;
  return {kInstancesGrid,
          "instances: where prototypes stand",
          places(rows, [](const I& i) { return i.position_m; }),
          {column("position", rows, [](const I& i) { return i.position_m; }),
           column("yaw", rows, [](const I& i) { return i.yaw_rad; }),
           column("scale", rows, [](const I& i) { return i.scale; }),
           column("prototype", rows, [](const I& i) { return static_cast<Int>(i.prototype.value); }),
           column("tree", rows, [](const I& i) { return static_cast<Int>(i.tree.value); })}};
}

ElementShape shape_from(Int value) {
  if (value < 0 || value > static_cast<Int>(ElementShape::kShoot)) throw std::runtime_error("unknown shape");
  return static_cast<ElementShape>(value);
}

}  // namespace

std::string grid_name(const char* kind, std::size_t prototype) {
  return std::string(kind) + "_" + std::to_string(prototype);
}

std::vector<PointTable> tables_of(const Forest& forest) {
  std::vector<PointTable> tables{instance_table(forest.instances)};
  for (std::size_t p = 0; p < forest.prototypes.size(); ++p) {
    tables.push_back(foliage_table(forest.prototypes[p], p));
    tables.push_back(wood_table(forest.prototypes[p], p));
    tables.push_back(wood_mesh_table(forest.prototypes[p], p));
  }
  return tables;
}

std::vector<FoliageElement> foliage_from(const PointTable& table) {
  std::vector<FoliageElement> rows;
  read_column<Vec3f>(table, "centre", rows, [](auto& row, const Vec3f& v) { row.centre_m = v; });
  read_column<Vec3f>(table, "half_u", rows, [](auto& row, const Vec3f& v) { row.half_u_m = v; });
  read_column<Vec3f>(table, "half_v", rows, [](auto& row, const Vec3f& v) { row.half_v_m = v; });
  read_column<float>(table, "area", rows, [](auto& row, float v) { row.area_m2 = v; });
  read_column<Int>(table, "shape", rows, [](auto& row, Int v) { row.shape = shape_from(v); });
  read_column<Int>(table, "material", rows,
                   [](auto& row, Int v) { row.material = static_cast<std::uint16_t>(v); });
  return rows;
}

std::vector<WoodSegment> wood_from(const PointTable& table) {
  std::vector<WoodSegment> rows;
  read_column<Vec3f>(table, "from", rows, [](auto& row, const Vec3f& v) { row.from_m = v; });
  read_column<Vec3f>(table, "to", rows, [](auto& row, const Vec3f& v) { row.to_m = v; });
  read_column<float>(table, "radius_from", rows, [](auto& row, float v) { row.radius_from_m = v; });
  read_column<float>(table, "radius_to", rows, [](auto& row, float v) { row.radius_to_m = v; });
  read_column<Int>(table, "material", rows,
                   [](auto& row, Int v) { row.material = static_cast<std::uint32_t>(v); });
  return rows;
}

std::vector<WoodTriangle> wood_mesh_from(const PointTable& table) {
  std::vector<WoodTriangle> rows;
  read_column<Vec3f>(table, "a", rows, [](auto& row, const Vec3f& v) { row.a_m = v; });
  read_column<Vec3f>(table, "b", rows, [](auto& row, const Vec3f& v) { row.b_m = v; });
  read_column<Vec3f>(table, "c", rows, [](auto& row, const Vec3f& v) { row.c_m = v; });
  read_column<Int>(table, "material", rows,
                   [](auto& row, Int v) { row.material = static_cast<std::uint32_t>(v); });
  return rows;
}

std::vector<Instance> instances_from(const PointTable& table) {
  std::vector<Instance> rows;
  read_column<Vec3>(table, "position", rows, [](auto& row, const Vec3& v) { row.position_m = v; });
  read_column<float>(table, "yaw", rows, [](auto& row, float v) { row.yaw_rad = v; });
  read_column<float>(table, "scale", rows, [](auto& row, float v) { row.scale = v; });
  read_column<Int>(table, "prototype", rows,
                   [](auto& row, Int v) { row.prototype.value = static_cast<std::uint32_t>(v); });
  read_column<Int>(table, "tree", rows,
                   [](auto& row, Int v) { row.tree.value = static_cast<std::uint32_t>(v); });
  return rows;
}

}  // namespace sunfleck
