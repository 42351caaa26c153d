// One density grid is a FloatGrid of class fog volume; one table is a PointDataGrid whose attributes are the
// columns, without any lossy codec, and an attribute "row" that remembers the order. Voxels of point grids
// are sized for about eight points each, so that a leaf node of the tree holds some hundreds.

#include "sim/grid/vdb_archive.h"

#include <openvdb/openvdb.h>
#include <openvdb/points/PointConversion.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>

namespace sunfleck {

namespace {

using openvdb::points::NullCodec;
using openvdb::points::PointDataGrid;
using openvdb::tools::PointIndexGrid;

constexpr const char* kDescription = "sunfleck_forest";
constexpr const char* kIntegral = "sunfleck_integral";
constexpr const char* kAbout = "about";
constexpr const char* kRow = "row";
constexpr double kLeastVoxelM = 1e-4;
constexpr double kMaxCoordinate = 1e9;  // voxel indexes are 32 bits; the grid place saturates, columns do not

void initialize_openvdb() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

// The types of attributes, as OpenVDB names them.
template <class T>
struct Stored {
  using Type = T;
  static T from(const T& value) { return value; }
  static T back(const T& value) { return value; }
};
template <class Glm, class Vdb>
struct StoredVector {
  using Type = Vdb;
  static Vdb from(const Glm& v) { return {v.x, v.y, v.z}; }
  static Glm back(const Vdb& v) { return {v.x(), v.y(), v.z()}; }
};
template <>
struct Stored<Vec3f> : StoredVector<Vec3f, openvdb::Vec3s> {};
template <>
struct Stored<Vec3> : StoredVector<Vec3, openvdb::Vec3d> {};

// ---- writing

openvdb::FloatGrid::Ptr grid_of(const DensityGrid& density) {
  auto grid = openvdb::FloatGrid::create(0.0F);
  grid->setName(density.name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(density.cell_m));
  // OpenVDB's index points are voxel centres; ours are low corners: shift by half a cell.
  grid->transform().postTranslate(openvdb::Vec3d(0.5 * density.cell_m));
  auto accessor = grid->getAccessor();
  for (const DensityCell& cell : density.cells) {
    accessor.setValue({cell.index[0], cell.index[1], cell.index[2]}, cell.value);
  }
  grid->insertMeta(kAbout, openvdb::StringMetadata(density.about));
  grid->insertMeta(kIntegral, openvdb::DoubleMetadata(density.integral));
  return grid;
}

std::vector<openvdb::Vec3d> grid_places(const PointTable& table) {
  std::vector<openvdb::Vec3d> places;
  places.reserve(table.positions_m.size());
  for (const Vec3& p : table.positions_m) {
    const Vec3 place = glm::clamp(p, Vec3(-kMaxCoordinate), Vec3(kMaxCoordinate));
    places.emplace_back(place.x, place.y, place.z);
  }
  return places;
}

// About eight points per voxel if they were spread evenly; never so fine that an index could overflow or that
// OpenVDB takes the voxel's volume for zero.
double point_voxel_m(const std::vector<openvdb::Vec3d>& places) {
  openvdb::BBoxd box;
  for (const openvdb::Vec3d& place : places) box.expand(place);
  const openvdb::Vec3d extents = box.extents();
  const double largest = std::max({extents.x(), extents.y(), extents.z(), 1e-3});
  double volume = 1.0;
  for (int axis = 0; axis < 3; ++axis) volume *= std::max(extents[axis], 0.05 * largest);
  const double even = std::cbrt(8.0 * volume / static_cast<double>(places.size()));
  const double reach = std::max(box.max().length(), box.min().length());
  return std::max({even, reach * 1e-6, kLeastVoxelM});
}

template <class T>
void append_column(PointDataGrid& grid, const PointIndexGrid& rows, const std::string& name,
                   const std::vector<T>& values) {
  using Value = typename Stored<T>::Type;
  std::vector<Value> stored;
  stored.reserve(values.size());
  for (const T& value : values) stored.push_back(Stored<T>::from(value));
  openvdb::points::appendAttribute<Value, NullCodec>(grid.tree(), name);
  openvdb::points::populateAttribute(grid.tree(), rows.tree(), name,
                                     openvdb::points::PointAttributeVector<Value>(stored));
}

PointDataGrid::Ptr grid_of(const PointTable& table) {
  const std::size_t rows = table.positions_m.size();
  const std::vector<openvdb::Vec3d> places = grid_places(table);
  const auto transform = openvdb::math::Transform::createLinearTransform(point_voxel_m(places));
  const openvdb::points::PointAttributeVector<openvdb::Vec3d> positions(places);
  const auto index = openvdb::tools::createPointIndexGrid<PointIndexGrid>(positions, *transform);
  auto grid = openvdb::points::createPointDataGrid<NullCodec, PointDataGrid>(*index, positions, *transform);
  grid->setName(table.name);
  grid->insertMeta(kAbout, openvdb::StringMetadata(table.about));
  grid->insertMeta(kIntegral, openvdb::DoubleMetadata(static_cast<double>(rows)));
  for (const PointColumn& column : table.columns) {
    std::visit([&](const auto& values) { append_column(*grid, *index, column.name, values); }, column.values);
  }
  std::vector<std::int32_t> numbers(rows);
  for (std::size_t i = 0; i < rows; ++i) numbers[i] = static_cast<std::int32_t>(i);
  append_column(*grid, *index, kRow, numbers);
  return grid;
}

// Lets us write to our own stream, which throws when the disk is full; io::File's own does not look.
class StreamArchive : public openvdb::io::Archive {
 public:
  void write_to(std::ostream& out, const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& meta) const {
    Archive::write(out, grids, /*seekable=*/true, meta);
  }
};

// ---- reading

using Leaf = openvdb::points::PointDataTree::LeafNodeType;

template <class T>
void copy_column(const Leaf& leaf, const std::string& name, const std::vector<std::int32_t>& rows,
                 std::vector<T>& values) {
  const openvdb::points::AttributeHandle<typename Stored<T>::Type> handle(leaf.constAttributeArray(name));
  if (handle.size() != rows.size()) throw std::runtime_error("column " + name + " has a wrong length");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    values[static_cast<std::size_t>(rows[i])] = Stored<T>::back(handle.get(static_cast<openvdb::Index>(i)));
  }
}

// The rows that a leaf node holds; each row of the table must come exactly once.
std::vector<std::int32_t> rows_of(const Leaf& leaf, std::vector<bool>& seen) {
  const openvdb::points::AttributeHandle<std::int32_t> handle(leaf.constAttributeArray(kRow));
  std::vector<std::int32_t> rows(handle.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i] = handle.get(static_cast<openvdb::Index>(i));
    const auto row = static_cast<std::size_t>(rows[i]);
    if (rows[i] < 0 || row >= seen.size() || seen[row]) throw std::runtime_error("its rows are disordered");
    seen[row] = true;
  }
  return rows;
}

ColumnValues empty_column(const openvdb::Name& type, std::size_t rows) {
  if (type == openvdb::typeNameAsString<std::int32_t>()) return std::vector<std::int32_t>(rows);
  if (type == openvdb::typeNameAsString<float>()) return std::vector<float>(rows);
  if (type == openvdb::typeNameAsString<double>()) return std::vector<double>(rows);
  if (type == openvdb::typeNameAsString<openvdb::Vec3s>()) return std::vector<Vec3f>(rows);
  if (type == openvdb::typeNameAsString<openvdb::Vec3d>()) return std::vector<Vec3>(rows);
  throw std::runtime_error("a column has the unknown type " + type);
}

PointTable table_of(const PointDataGrid& grid) {
  PointTable table;
  table.name = grid.getName();
  const auto first = grid.tree().cbeginLeaf();
  if (!first) return table;
  const std::size_t count = openvdb::points::pointCount(grid.tree());
  const auto& descriptor = first->attributeSet().descriptor();
  for (const auto& [name, position] : descriptor.map()) {
    if (name == kRow || name == "P") continue;
    table.columns.push_back({name, empty_column(descriptor.valueType(position), count)});
  }
  std::vector<bool> seen(count);
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
    const std::vector<std::int32_t> rows = rows_of(*leaf, seen);
    for (PointColumn& column : table.columns) {
      std::visit([&](auto& values) { copy_column(*leaf, column.name, rows, values); }, column.values);
    }
  }
  return table;
}

}  // namespace

void write_vdb(const VdbContent& content, std::ostream& out) {
  initialize_openvdb();
  openvdb::GridCPtrVec grids;
  for (const DensityGrid& density : content.densities) grids.push_back(grid_of(density));
  for (const PointTable& table : content.tables) {
    if (!table.positions_m.empty()) grids.push_back(grid_of(table));
  }
  openvdb::MetaMap meta;
  meta.insertMeta(kDescription, openvdb::StringMetadata(content.description));
  meta.insertMeta("creator", openvdb::StringMetadata("Sunfleck"));
  StreamArchive().write_to(out, grids, meta);
}

VdbContent read_vdb(const std::filesystem::path& path) {
  initialize_openvdb();
  openvdb::io::File file(path.string());
  file.open(/*delayLoad=*/false);
  VdbContent content;
  content.description = file.getMetadata()->metaValue<std::string>(kDescription);
  for (auto name = file.beginName(); name != file.endName(); ++name) {
    const auto metadata = file.readGridMetadata(name.gridName());
    if (!metadata->isType<PointDataGrid>()) continue;
    const auto grid = openvdb::gridPtrCast<PointDataGrid>(file.readGrid(name.gridName()));
    if (!grid) throw std::runtime_error("grid " + name.gridName() + " is no point grid");
    content.tables.push_back(table_of(*grid));
  }
  return content;
}

VdbContent read_vdb(const std::filesystem::path& path,
                    const std::function<bool(const std::string&)>& wanted) {
  initialize_openvdb();
  openvdb::io::File file(path.string());
  file.open(/*delayLoad=*/false);
  VdbContent content;
  content.description = file.getMetadata()->metaValue<std::string>(kDescription);
  for (auto name = file.beginName(); name != file.endName(); ++name) {
    if (!wanted(name.gridName())) continue;
    const auto grid = openvdb::gridPtrCast<PointDataGrid>(file.readGrid(name.gridName()));
    if (!grid) throw std::runtime_error("grid " + name.gridName() + " is no point grid");
    content.tables.push_back(table_of(*grid));
  }
  return content;
}

std::vector<GridSummary> summarize_vdb(const std::filesystem::path& path) {
  initialize_openvdb();
  openvdb::io::File file(path.string());
  file.open(/*delayLoad=*/false);
  std::vector<GridSummary> summaries;
  const openvdb::GridPtrVecPtr grids = file.readAllGridMetadata();
  for (const openvdb::GridBase::Ptr& grid : *grids) {
    GridSummary summary;
    summary.name = grid->getName();
    summary.type = grid->isType<PointDataGrid>() ? "points" : grid->valueType();
    summary.voxel_size_m = grid->voxelSize().x();
    summary.active_voxels =
        static_cast<std::uint64_t>(grid->metaValue<openvdb::Int64>(openvdb::GridBase::META_FILE_VOXEL_COUNT));
    summary.integral = grid->metaValue<double>(kIntegral);
    summaries.push_back(summary);
  }
  return summaries;
}

}  // namespace sunfleck
