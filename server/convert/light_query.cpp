// Head comment in light_query.h.
#include "server/convert/light_query.h"

#include <set>

#include "server/convert/light_map_message.h"
#include "sunfleck/v1/light.pb.h"

namespace sunfleck {
namespace {

// Calls `use(element)` for every element asked for.
template <class Use>
void for_each_element(const v1::QueryLightRequest& request, const Use& use) {
  for (const v1::ElementRange& range : request.element_ranges()) {
    for (std::uint64_t i = 0; i < range.count(); ++i) use(static_cast<std::size_t>(range.first() + i));
  }
}

void add_element(const BandLightMap& band, std::size_t i, v1::ElementValues& values) {
  const ElementLight& light = band.elements[i];
  values.add_front_direct_w_m2(light.front.direct_w_m2);
  values.add_front_sky_w_m2(light.front.sky_w_m2);
  values.add_front_scattered_w_m2(light.front.scattered_w_m2);
  values.add_back_direct_w_m2(light.back.direct_w_m2);
  values.add_back_sky_w_m2(light.back.sky_w_m2);
  values.add_back_scattered_w_m2(light.back.scattered_w_m2);
  values.add_absorbed_w(light.absorbed_w);
  if (!band.standard_error_w_m2.empty()) values.add_standard_error_w_m2(band.standard_error_w_m2[i]);
}

void fill_tree(const TreeLight& tree, v1::TreeValues& message) {
  message.set_id_tree(tree.tree.value);
  message.set_instance(tree.instance);
  message.set_leaf_area_m2(tree.leaf_area_m2);
  message.set_sunlit_leaf_area_m2(tree.sunlit_leaf_area_m2);
  message.set_absorbed_w(tree.absorbed_w);
  message.set_absorbed_standard_error_w(tree.absorbed_standard_error_w);
  message.set_mean_irradiance_w_m2(tree.mean_irradiance_w_m2);
}

}  // namespace

void check_query_size(const v1::QueryLightRequest& request, const Limits& limits, Violations& violations) {
  std::uint64_t elements = 0;
  for (const v1::ElementRange& range : request.element_ranges()) {
    elements =
        std::min<std::uint64_t>(elements + std::min<std::uint64_t>(range.count(), 1ull << 40), 1ull << 50);
  }
  violations.integer("element_ranges", static_cast<std::int64_t>(elements), 0, limits.query_elements);
  violations.count("id_trees", static_cast<std::size_t>(request.id_trees_size()), 0, limits.query_elements);
  if (elements == 0 && request.id_trees_size() == 0) {
    violations.add("element_ranges", "must name elements, or id_trees must name trees");
  }
}

void check_query_places(const v1::QueryLightRequest& request, const Forest& forest, Violations& violations) {
  const std::uint64_t elements = ForestIndex(forest).element_count();  // of the trees the light is for
  for (int i = 0; i < request.element_ranges_size(); ++i) {
    const v1::ElementRange& range = request.element_ranges(i);
    if (range.first() <= elements && range.count() <= elements - range.first()) continue;
    violations.add(at("element_ranges", static_cast<std::size_t>(i)),
                   "must lie within the " + std::to_string(elements) + " elements of the scene");
  }
  std::set<std::uint32_t> known;
  for (const Instance& instance : forest.instances) known.insert(instance.tree.value);
  for (int i = 0; i < request.id_trees_size(); ++i) {
    if (known.contains(request.id_trees(i))) continue;
    violations.add(at("id_trees", static_cast<std::size_t>(i)),
                   "the scene has no tree " + std::to_string(request.id_trees(i)));
  }
}

void fill_answer(const v1::QueryLightRequest& request, const LightMap& map,
                 v1::QueryLightResponse& response) {
  const std::set<std::uint32_t> wanted(request.id_trees().begin(), request.id_trees().end());
  for (const BandLightMap& band : map.bands) {
    v1::BandAnswer& answer = *response.add_bands();
    fill_message(band, *answer.mutable_summary());
    for_each_element(request, [&](std::size_t i) { add_element(band, i, *answer.mutable_elements()); });
    for (const TreeLight& tree : band.trees) {
      if (wanted.contains(tree.tree.value)) fill_tree(tree, *answer.add_trees());
    }
  }
  for_each_element(request, [&](std::size_t i) { response.add_sunlit_fraction(map.sunlit_fraction[i]); });
  fill_message(map.provenance, *response.mutable_provenance());
}

}  // namespace sunfleck
