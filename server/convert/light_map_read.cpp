// The wire back to a light map, bit by bit.
#include <cstring>
#include <map>

#include "server/convert/light_map_message.h"
#include "sim/base/error.h"
#include "sunfleck/v1/light.pb.h"

namespace sunfleck {
namespace {

using ArraysByName = std::map<std::string, const ReceivedArray*>;

[[noreturn]] void refuse(const std::string& array, const std::string& problem) {
  throw Error(ErrorKind::kInputOutput, "array '" + array + "'", problem,
              "the stream is damaged or of another version; ask again");
}

// The bytes of the named array as `T`s.
template <class T>
std::vector<T> values_of(const ArraysByName& arrays, const std::string& name, ElementType type) {
  const auto found = arrays.find(name);
  if (found == arrays.end()) refuse(name, "missing in the answer");
  const std::string& bytes = found->second->bytes;
  if (found->second->type != type || bytes.size() % sizeof(T) != 0) refuse(name, "has another type");
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
  return values;
}

EnergyBudget budget_from_message(const v1::EnergyBudget& message) {
  return {message.incident_w(),
          message.absorbed_foliage_w(),
          message.absorbed_wood_w(),
          message.absorbed_ground_w(),
          message.escaped_w(),
          message.residual_w(),
          message.residual_standard_error_w()};
}

std::vector<TreeLight> trees_of(const ArraysByName& arrays, const std::string& band) {
  constexpr std::size_t kColumns = 5;
  const auto ids = values_of<std::uint32_t>(arrays, band + "/tree_ids", ElementType::kUint32);
  const auto light = values_of<double>(arrays, band + "/tree_light", ElementType::kFloat64);
  if (ids.size() * kColumns != light.size() * 2) refuse(band + "/tree_light", "does not fit tree_ids");
  std::vector<TreeLight> trees(ids.size() / 2);
  for (std::size_t i = 0; i < trees.size(); ++i) {
    const double* row = &light[i * kColumns];
    trees[i] = {TreeId{ids[2 * i]}, ids[2 * i + 1], row[0], row[1], row[2], row[3], row[4]};
  }
  return trees;
}

BandLightMap band_from_messages(const ArraysByName& arrays, const v1::BandSummary& summary) {
  BandLightMap band;
  band.band = summary.band();
  band.elements = values_of<ElementLight>(arrays, band.band + "/element_light", ElementType::kFloat32);
  if (summary.has_standard_error()) {
    band.standard_error_w_m2 =
        values_of<float>(arrays, band.band + "/standard_error_w_m2", ElementType::kFloat32);
  }
  band.trees = trees_of(arrays, band.band);
  band.has_budget = summary.has_budget();
  if (band.has_budget) band.budget = budget_from_message(summary.budget());
  band.mean_irradiance_w_m2 = summary.mean_irradiance_w_m2();
  band.mean_irradiance_standard_error_w_m2 = summary.mean_irradiance_standard_error_w_m2();
  return band;
}

}  // namespace

Provenance provenance_from_message(const v1::Provenance& message) {
  Provenance provenance;
  provenance.method = message.method();
  provenance.version = message.version();
  provenance.forest_hash = message.forest_hash();
  provenance.seed = message.seed();
  for (const v1::Setting& s : message.settings()) provenance.settings.emplace_back(s.name(), s.value());
  for (const v1::SkipNote& s : message.skipped()) {
    provenance.skipped.push_back({s.what(), s.reason(), s.relative_bound()});
  }
  provenance.notes.assign(message.notes().begin(), message.notes().end());
  for (const v1::StageTime& t : message.times()) {
    provenance.times.push_back({t.stage(), t.wall_s(), t.cpu_s()});
  }
  return provenance;
}

LightMap light_map_from_messages(const std::vector<ReceivedArray>& arrays,
                                 const v1::LightMapSummary& summary) {
  if (arrays.size() != summary.array_count()) refuse("*", "not as many as the summary says");
  ArraysByName by_name;
  for (const ReceivedArray& array : arrays) by_name[array.name] = &array;
  LightMap map;
  map.sunlit_fraction = values_of<float>(by_name, "sunlit_fraction", ElementType::kFloat32);
  for (const v1::BandSummary& band : summary.bands()) map.bands.push_back(band_from_messages(by_name, band));
  map.provenance = provenance_from_message(summary.provenance());
  for (const BandLightMap& band : map.bands) {
    if (band.elements.size() != map.sunlit_fraction.size())
      refuse(band.band, "has another number of elements");
    if (!band.standard_error_w_m2.empty() && band.standard_error_w_m2.size() != band.elements.size())
      refuse(band.band, "has another number of standard errors");
  }
  return map;
}

}  // namespace sunfleck
