// Head comment in stand_answer.h: the wire back to a study.
#include <algorithm>
#include <cstring>
#include <map>

#include "server/convert/light_map_message.h"
#include "server/convert/stand_answer.h"
#include "server/convert/stand_columns.h"
#include "server/convert/stand_fields.h"
#include "sim/base/error.h"
#include "sunfleck/v1/stand_light.pb.h"

namespace sunfleck {
namespace {

[[noreturn]] void refuse(const std::string& array, const std::string& problem) {
  throw Error(ErrorKind::kInputOutput, "array '" + array + "'", problem,
              "the stream is damaged or of another version; ask again");
}

class Arrays {
 public:
  explicit Arrays(const std::vector<ReceivedArray>& arrays) {
    for (const ReceivedArray& array : arrays) by_name_[array.name] = &array;
  }
  bool has(const std::string& name) const { return by_name_.contains(name); }

  // Of that many dimensions and as many values as its shape says.
  template <class T>
  std::vector<T> values(const std::string& name, ElementType type, std::size_t dimensions,
                        std::vector<std::uint64_t>& shape) const {
    const auto found = by_name_.find(name);
    if (found == by_name_.end()) refuse(name, "missing in the answer");
    const ReceivedArray& array = *found->second;
    if (array.type != type || array.shape.size() != dimensions) refuse(name, "has another type");
    std::uint64_t count = array.bytes.size() / sizeof(T);
    std::vector<T> values(count);
    for (const std::uint64_t n : array.shape) count = n == 0 || count % n != 0 ? 0 : count / n;
    const bool has_no_place = std::find(array.shape.begin(), array.shape.end(), 0u) != array.shape.end();
    const bool is_empty = has_no_place && array.bytes.empty();
    if (!is_empty && (count != 1 || array.bytes.size() % sizeof(T) != 0))
      refuse(name, "does not fit its shape");
    if (!is_empty) std::memcpy(values.data(), array.bytes.data(), array.bytes.size());
    shape = array.shape;
    return values;
  }

 private:
  std::map<std::string, const ReceivedArray*> by_name_;
};

// Puts what arrived in its place.
class Fill {
 public:
  explicit Fill(const Arrays& arrays) : arrays_(arrays) {}

  void table(const std::string& name, IntervalTable& table) {
    std::vector<std::uint64_t> shape, error_shape;
    table.value = arrays_.values<float>(name, ElementType::kFloat32, 2, shape);
    table.standard_error = arrays_.values<float>(name + kErrorSuffix, ElementType::kFloat32, 2, error_shape);
    if (shape != error_shape) refuse(name, "has errors of another shape");
    table.intervals = shape[0];
    table.targets = shape[1];
  }
  void numbers(const std::string& name, std::vector<double>& values) {
    std::vector<std::uint64_t> shape;
    values = arrays_.values<double>(name, ElementType::kFloat64, 1, shape);
  }
  using Column = std::pair<const char*, std::vector<double>*>;
  void columns(const std::string& name, const std::vector<Column>& columns) {
    std::vector<std::uint64_t> shape;
    const auto all = arrays_.values<double>(name, ElementType::kFloat64, 2, shape);
    if (shape[1] != columns.size()) refuse(name, "has other columns");
    for (std::size_t i = 0; i < all.size(); ++i) columns[i % columns.size()].second->push_back(all[i]);
  }

 private:
  const Arrays& arrays_;
};

StandGround map_from_message(const v1::GroundMap& message) {
  StandGround ground;
  ground.lo_m = {message.x_from_m(), message.y_from_m()};
  ground.cell_m = {message.cell_x_m(), message.cell_y_m()};
  ground.nx = message.cells_x();
  ground.ny = message.cells_y();
  ground.normal = {message.normal().x(), message.normal().y(), message.normal().z()};
  ground.periodic = message.periodic();
  return ground;
}

std::vector<SensorCanopy> canopy_from(const Arrays& arrays) {
  std::vector<std::uint64_t> shape, of_10, of_lai;
  const auto numbers = arrays.values<double>("sensor_canopy", ElementType::kFloat64, 2, shape);
  const auto rings_10 = arrays.values<double>("sensor_gap_rings_10_deg", ElementType::kFloat64, 3, of_10);
  const auto rings_lai = arrays.values<double>("sensor_gap_rings_lai2000", ElementType::kFloat64, 3, of_lai);
  std::vector<SensorCanopy> canopy(shape[0]);
  if (shape[1] != kCanopyNumbers.size() || of_10[0] != shape[0] || of_lai[0] != shape[0] ||
      of_10[2] != kRingNumbers.size() || of_lai[2] != kRingNumbers.size() || of_lai[1] != 5)
    refuse("sensor_canopy", "does not fit its rings");
  const double *number = numbers.data(), *ring_10 = rings_10.data(), *ring_lai = rings_lai.data();
  for (SensorCanopy& sensor : canopy) {
    for (double SensorCanopy::*member : kCanopyNumbers) sensor.*member = *number++;
    sensor.rings_10_deg.resize(of_10[1]);
    for (GapRing& ring : sensor.rings_10_deg)
      for (double GapRing::*member : kRingNumbers) ring.*member = *ring_10++;
    for (GapRing& ring : sensor.rings_lai2000)
      for (double GapRing::*member : kRingNumbers) ring.*member = *ring_lai++;
  }
  return canopy;
}

// What all intervals have in common.
StandLight stand_from(const Arrays& arrays, const v1::StandLightSummary& summary) {
  StandLight light;
  Fill fill(arrays);
  std::vector<std::uint64_t> shape;
  for (const std::uint32_t id : arrays.values<std::uint32_t>("tree_ids", ElementType::kUint32, 1, shape))
    light.tree_ids.push_back(TreeId{id});
  visit_stand(light, fill);
  if (arrays.has("sensor_canopy")) light.canopy = canopy_from(arrays);
  light.map = map_from_message(summary.map());
  light.layers.layer_m = summary.layer_m();
  light.plot.leaf_area_index = summary.leaf_area_index();
  for (const std::string& band : summary.bands()) light.plot.bands.emplace_back().band = band;
  const auto bands = static_cast<std::size_t>(summary.bands_size());
  light.ground.scattered.resize(bands);
  light.trees.absorbed.resize(bands);
  light.layers.absorbed.resize(bands);
  return light;
}

StandLight intervals_from(const Arrays& arrays, const std::string& begin, StandLight light,
                          std::vector<std::string> labels) {
  Fill fill(arrays);
  visit_intervals(begin, light, fill);
  light.intervals = std::move(labels);
  if (light.ground.total.intervals != light.intervals.size()) refuse(begin, "has other intervals");
  return light;
}

void read_intervals(const v1::StandLightSummary& summary, StandStudy& study) {
  for (const v1::StandInterval& interval : summary.intervals()) {
    study.intervals.push_back(interval.label());
    study.interval_begin_s.push_back(interval.begin_unix_s() - kUnixOf2000_s);
    study.interval_end_s.push_back(interval.end_unix_s() - kUnixOf2000_s);
    study.direct_horizontal_mj_m2.push_back(interval.direct_horizontal_mj_m2());
    study.diffuse_horizontal_mj_m2.push_back(interval.diffuse_horizontal_mj_m2());
  }
  if (study.intervals.empty()) refuse("intervals", "there are none");
}

LargeStandLight world_from(const Arrays& arrays, const v1::StandLightSummary& summary,
                           const std::vector<std::string>& whole, const std::vector<std::string>& parts) {
  LargeStandLight world;
  Fill fill(arrays);
  visit_world(world, fill);
  world.map = map_from_message(summary.map());
  world.intervals = parts.empty() ? whole : parts;
  if (world.ground_total.intervals != world.intervals.size()) refuse("world/", "has other intervals");
  return world;
}

}  // namespace

StandStudy stand_study_from_messages(const std::vector<ReceivedArray>& received,
                                     const v1::StandLightSummary& summary, const StandStudySpec& spec) {
  if (received.size() != summary.array_count()) refuse("*", "not as many as the summary says");
  const Arrays arrays(received);
  StandStudy study;
  study.spec = spec;
  read_intervals(summary, study);
  const std::vector<std::string> whole(study.intervals.begin(), study.intervals.begin() + 1);
  const std::vector<std::string> parts(study.intervals.begin() + 1, study.intervals.end());
  if (summary.by_rays()) {
    const StandLight stand = stand_from(arrays, summary);
    study.period = intervals_from(arrays, "period/", stand, whole);
    if (summary.has_parts()) study.parts = intervals_from(arrays, "parts/", stand, parts);
  } else {
    study.world = world_from(arrays, summary, whole, parts);
  }
  if (summary.has_fit())
    study.fit = SensorFit{summary.fit().sensors(), summary.fit().rmse(), summary.fit().bias(),
                          summary.fit().correlation()};
  study.provenance = provenance_from_message(summary.provenance());
  return study;
}

}  // namespace sunfleck
