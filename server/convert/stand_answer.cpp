// Head comment in stand_answer.h: lighting to the wire.
#include "server/convert/stand_answer.h"

#include "lighting/map/stand_tables.h"
#include "server/convert/light_map_message.h"
#include "server/convert/stand_columns.h"
#include "server/convert/stand_fields.h"
#include "sunfleck/v1/stand_light.pb.h"

namespace sunfleck {
namespace {

// A member that is added to these must get its name in stand_fields.h.
constexpr std::size_t kTable = sizeof(IntervalTable), kVector = sizeof(std::vector<double>);
static_assert(sizeof(SensorTables) == 8 * kTable + 3 * kVector);
static_assert(sizeof(GroundTables) == 3 * kTable + kVector);
static_assert(sizeof(TreeTables) == 4 * kTable + kVector);
static_assert(sizeof(LayerTables) == sizeof(double) + 3 * kTable + 2 * kVector);
static_assert(sizeof(PlotBand) == sizeof(std::string) + 9 * kVector);
static_assert(sizeof(PlotTables) == sizeof(double) + 10 * kVector);
static_assert(sizeof(StandLight) == 4 * kVector + sizeof(StandGround) + sizeof(SensorTables) +
                                        sizeof(GroundTables) + sizeof(TreeTables) + sizeof(LayerTables) +
                                        sizeof(PlotTables));
static_assert(sizeof(LargeStandLight) == 4 * kVector + sizeof(StandGround) + 6 * kTable);
static_assert(sizeof(SensorCanopy) ==
              kCanopyNumbers.size() * sizeof(double) + kVector + 5 * kRingNumbers.size() * sizeof(double));

template <class T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
  return std::as_bytes(std::span<const T>(values));
}

class Collect {
 public:
  Collect(std::vector<ArrayView>& views, std::deque<std::vector<double>>& gathered)
      : views_(views), gathered_(gathered) {}

  void table(const std::string& name, const IntervalTable& table) {
    const std::vector<std::uint64_t> shape = {table.intervals, table.targets};
    views_.push_back({name, ElementType::kFloat32, shape, {}, bytes_of(table.value)});
    views_.push_back({name + kErrorSuffix, ElementType::kFloat32, shape, {}, bytes_of(table.standard_error)});
  }
  void numbers(const std::string& name, const std::vector<double>& values) {
    views_.push_back({name, ElementType::kFloat64, {values.size()}, {}, bytes_of(values)});
  }
  using Column = std::pair<const char*, const std::vector<double>*>;
  void columns(const std::string& name, const std::vector<Column>& columns) {
    const std::size_t rows = columns.front().second->size();
    std::vector<double>& all = gathered_.emplace_back();
    for (std::size_t row = 0; row < rows; ++row)
      for (const Column& column : columns) all.push_back((*column.second)[row]);
    std::vector<std::string> names;
    for (const Column& column : columns) names.emplace_back(column.first);
    views_.push_back({name, ElementType::kFloat64, {rows, columns.size()}, names, bytes_of(all)});
  }

 private:
  std::vector<ArrayView>& views_;
  std::deque<std::vector<double>>& gathered_;
};

void fill_map(const StandGround& ground, v1::GroundMap& message) {
  message.set_x_from_m(ground.lo_m.x);
  message.set_y_from_m(ground.lo_m.y);
  message.set_cell_x_m(ground.cell_m.x);
  message.set_cell_y_m(ground.cell_m.y);
  message.set_cells_x(ground.nx);
  message.set_cells_y(ground.ny);
  message.mutable_normal()->set_x(ground.normal.x);
  message.mutable_normal()->set_y(ground.normal.y);
  message.mutable_normal()->set_z(ground.normal.z);
  message.set_periodic(ground.periodic);
}

void fill_fit(const SensorFit& fit, v1::SensorFit& message) {
  message.set_sensors(fit.sensors);
  message.set_rmse(fit.rmse);
  message.set_bias(fit.bias);
  message.set_correlation(fit.correlation);
}

}  // namespace

StandArrays::StandArrays(std::shared_ptr<const StandStudy> study, const Forest* forest)
    : study_(std::move(study)) {
  Collect collect(views_, gathered_);
  if (study_->period) {
    for (const TreeId tree : study_->period->tree_ids) tree_ids_.push_back(tree.value);
    views_.push_back({"tree_ids", ElementType::kUint32, {tree_ids_.size()}, {}, bytes_of(tree_ids_)});
    visit_stand(*study_->period, collect);
    if (!study_->period->canopy.empty()) add_canopy(study_->period->canopy);
    visit_intervals("period/", *study_->period, collect);
  }
  if (study_->parts) visit_intervals("parts/", *study_->parts, collect);
  if (study_->world) visit_world(*study_->world, collect);
  if (forest) add_plot(*forest);
}

// One row per interval; what is the same in all of them stands in every row.
void StandArrays::add_plot(const Forest& forest) {
  const StandTable plot = plot_figures(*study_, forest);
  std::vector<double>& values = gathered_.emplace_back();
  std::vector<std::string> columns;
  for (const StandVariable& v : plot.variables) columns.push_back(v.column());
  for (std::size_t i = 0; i < study_->intervals.size(); ++i)
    for (const StandVariable& v : plot.variables) values.push_back(v.value[v.per_interval ? i : 0]);
  views_.push_back(
      {"plot", ElementType::kFloat64, {study_->intervals.size(), columns.size()}, columns, bytes_of(values)});
}

void StandArrays::add_canopy(const std::vector<SensorCanopy>& canopy) {
  const std::uint64_t sensors = canopy.size();
  std::vector<double>&numbers = gathered_.emplace_back(), &rings_10 = gathered_.emplace_back(),
  &rings_lai = gathered_.emplace_back();
  for (const SensorCanopy& sensor : canopy) {
    for (double SensorCanopy::*number : kCanopyNumbers) numbers.push_back(sensor.*number);
    for (const GapRing& ring : sensor.rings_10_deg)
      for (double GapRing::*number : kRingNumbers) rings_10.push_back(ring.*number);
    for (const GapRing& ring : sensor.rings_lai2000)
      for (double GapRing::*number : kRingNumbers) rings_lai.push_back(ring.*number);
  }
  const auto add = [&](const char* name, const auto& column_names, std::vector<std::uint64_t> shape,
                       const std::vector<double>& values) {
    const std::vector<std::string> columns(column_names.begin(), column_names.end());
    shape.push_back(columns.size());
    views_.push_back({name, ElementType::kFloat64, std::move(shape), columns, bytes_of(values)});
  };
  add("sensor_canopy", kCanopyColumns, {sensors}, numbers);
  add("sensor_gap_rings_10_deg", kRingColumns, {sensors, canopy.front().rings_10_deg.size()}, rings_10);
  add("sensor_gap_rings_lai2000", kRingColumns, {sensors, canopy.front().rings_lai2000.size()}, rings_lai);
}

std::uint64_t StandArrays::size_bytes() const {
  std::uint64_t sum = 0;
  for (const ArrayView& view : views_) sum += view.bytes.size();
  return sum;
}

void fill_summary(const StandArrays& arrays, v1::StandLightSummary& message) {
  const StandStudy& study = arrays.study();
  fill_message(study.provenance, *message.mutable_provenance());
  for (std::size_t i = 0; i < study.intervals.size(); ++i) {
    v1::StandInterval& interval = *message.add_intervals();
    interval.set_label(study.intervals[i]);
    interval.set_begin_unix_s(study.interval_begin_s[i] + kUnixOf2000_s);
    interval.set_end_unix_s(study.interval_end_s[i] + kUnixOf2000_s);
    interval.set_direct_horizontal_mj_m2(study.direct_horizontal_mj_m2[i]);
    interval.set_diffuse_horizontal_mj_m2(study.diffuse_horizontal_mj_m2[i]);
  }
  message.set_by_rays(study.period.has_value());
  message.set_has_parts(study.parts.has_value());
  if (study.period) {
    fill_map(study.period->map, *message.mutable_map());
    for (const PlotBand& band : study.period->plot.bands) message.add_bands(band.band);
    message.set_layer_m(study.period->layers.layer_m);
    message.set_leaf_area_index(study.period->plot.leaf_area_index);
  } else if (study.world) {
    fill_map(study.world->map, *message.mutable_map());
  }
  message.set_par_fraction(study.spec.par.par_fraction);
  message.set_umol_per_j(study.spec.par.umol_per_j);
  if (study.fit) fill_fit(*study.fit, *message.mutable_fit());
  message.set_array_count(static_cast<std::uint32_t>(arrays.views().size()));
  message.set_size_bytes(arrays.size_bytes());
}

}  // namespace sunfleck
