// Head comment in light_map_message.h: lighting to the wire.
#include "server/convert/light_map_message.h"

#include <type_traits>

#include "sunfleck/v1/light.pb.h"

namespace sunfleck {
namespace {

// The element array is the memory of ElementLight itself.
static_assert(sizeof(ElementLight) == 7 * sizeof(float) && std::is_trivially_copyable_v<ElementLight>);

const std::vector<std::string> kElementColumns = {
    "front_direct_w_m2",   "front_sky_w_m2", "front_scattered_w_m2", "back_direct_w_m2", "back_sky_w_m2",
    "back_scattered_w_m2", "absorbed_w"};
const std::vector<std::string> kTreeColumns = {"leaf_area_m2", "sunlit_leaf_area_m2", "absorbed_w",
                                               "absorbed_standard_error_w", "mean_irradiance_w_m2"};

template <class T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
  return std::as_bytes(std::span<const T>(values));
}

void fill_budget(const EnergyBudget& budget, v1::EnergyBudget& message) {
  message.set_incident_w(budget.incident_w);
  message.set_absorbed_foliage_w(budget.absorbed_foliage_w);
  message.set_absorbed_wood_w(budget.absorbed_wood_w);
  message.set_absorbed_ground_w(budget.absorbed_ground_w);
  message.set_escaped_w(budget.escaped_w);
  message.set_residual_w(budget.residual_w);
  message.set_residual_standard_error_w(budget.residual_standard_error_w);
}

}  // namespace

LightMapArrays::LightMapArrays(std::shared_ptr<const LightMap> map) : map_(std::move(map)) {
  tree_ids_.reserve(map_->bands.size());
  tree_light_.reserve(map_->bands.size());
  views_.push_back({"sunlit_fraction",
                    ElementType::kFloat32,
                    {map_->sunlit_fraction.size()},
                    {},
                    bytes_of(map_->sunlit_fraction)});
  for (const BandLightMap& band : map_->bands) add_band(band);
}

void LightMapArrays::add_band(const BandLightMap& band) {
  views_.push_back({band.band + "/element_light",
                    ElementType::kFloat32,
                    {band.elements.size(), kElementColumns.size()},
                    kElementColumns,
                    bytes_of(band.elements)});
  if (!band.standard_error_w_m2.empty()) {
    views_.push_back({band.band + "/standard_error_w_m2",
                      ElementType::kFloat32,
                      {band.standard_error_w_m2.size()},
                      {},
                      bytes_of(band.standard_error_w_m2)});
  }
  std::vector<std::uint32_t>& ids = tree_ids_.emplace_back();
  std::vector<double>& light = tree_light_.emplace_back();
  for (const TreeLight& tree : band.trees) {
    ids.insert(ids.end(), {tree.tree.value, tree.instance});
    light.insert(light.end(), {tree.leaf_area_m2, tree.sunlit_leaf_area_m2, tree.absorbed_w,
                               tree.absorbed_standard_error_w, tree.mean_irradiance_w_m2});
  }
  views_.push_back({band.band + "/tree_ids",
                    ElementType::kUint32,
                    {band.trees.size(), 2},
                    {"id_tree", "instance"},
                    bytes_of(ids)});
  views_.push_back({band.band + "/tree_light",
                    ElementType::kFloat64,
                    {band.trees.size(), kTreeColumns.size()},
                    kTreeColumns,
                    bytes_of(light)});
}

std::uint64_t LightMapArrays::size_bytes() const {
  std::uint64_t sum = 0;
  for (const ArrayView& view : views_) sum += view.bytes.size();
  return sum;
}

void fill_message(const Provenance& provenance, v1::Provenance& message) {
  message.set_method(provenance.method);
  message.set_version(provenance.version);
  message.set_forest_hash(provenance.forest_hash);
  message.set_seed(provenance.seed);
  for (const auto& [name, value] : provenance.settings) {
    v1::Setting& setting = *message.add_settings();
    setting.set_name(name);
    setting.set_value(value);
  }
  for (const SkipNote& from : provenance.skipped) {
    v1::SkipNote& to = *message.add_skipped();
    to.set_what(from.what);
    to.set_reason(from.reason);
    to.set_relative_bound(from.relative_bound);
  }
  for (const std::string& note : provenance.notes) message.add_notes(note);
  for (const StageTime& from : provenance.times) {
    v1::StageTime& to = *message.add_times();
    to.set_stage(from.stage);
    to.set_wall_s(from.wall_s);
    to.set_cpu_s(from.cpu_s);
  }
}

void fill_message(const BandLightMap& band, v1::BandSummary& message) {
  message.set_band(band.band);
  message.set_mean_irradiance_w_m2(band.mean_irradiance_w_m2);
  message.set_mean_irradiance_standard_error_w_m2(band.mean_irradiance_standard_error_w_m2);
  message.set_has_standard_error(!band.standard_error_w_m2.empty());
  double absorbed_w = 0;
  for (const TreeLight& tree : band.trees) absorbed_w += tree.absorbed_w;
  message.set_absorbed_foliage_w(absorbed_w);
  if (band.has_budget) fill_budget(band.budget, *message.mutable_budget());
}

void fill_summary(const LightMap& map, const LightMapArrays& arrays, v1::LightMapSummary& message) {
  fill_message(map.provenance, *message.mutable_provenance());
  for (const BandLightMap& band : map.bands) fill_message(band, *message.add_bands());
  message.set_array_count(static_cast<std::uint32_t>(arrays.views().size()));
  message.set_size_bytes(arrays.size_bytes());
}

std::size_t memory_bytes(const LightMap& map) {
  std::size_t sum = map.sunlit_fraction.size() * sizeof(float);
  for (const BandLightMap& band : map.bands) {
    sum += band.elements.size() * sizeof(ElementLight) + band.standard_error_w_m2.size() * sizeof(float) +
           band.trees.size() * sizeof(TreeLight);
  }
  return sum;
}

}  // namespace sunfleck
