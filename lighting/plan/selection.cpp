#include "lighting/plan/selection.h"

#include <algorithm>
#include <map>
#include <string>

#include "lighting/base/summaries.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

std::string field(const char* list, std::size_t i) {
  return std::string("selection.") + list + "[" + std::to_string(i) + "]";
}

void add_trees(const Forest& forest, const std::vector<TreeId>& trees, std::vector<std::uint32_t>& chosen) {
  std::multimap<std::uint32_t, std::uint32_t> instance_of;
  for (std::uint32_t i = 0; i < forest.instances.size(); ++i)
    instance_of.emplace(forest.instances[i].tree.value, i);
  for (std::size_t k = 0; k < trees.size(); ++k) {
    const auto [first, end] = instance_of.equal_range(trees[k].value);
    if (first == end)
      throw_invalid(field("trees", k), "there is no tree " + std::to_string(trees[k].value),
                    "the id of a tree of this forest");
    for (auto it = first; it != end; ++it) chosen.push_back(it->second);
  }
}

// Of one instance from one run of values to another.
template <class T>
void copy_part(const std::vector<T>& from, const ForestIndex& index,
               const std::vector<std::uint32_t>& instances, std::vector<T>& to) {
  if (from.empty()) return;
  for (const std::uint32_t i : instances)
    to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(index.first_element(i)),
              from.begin() + static_cast<std::ptrdiff_t>(index.first_element(i + 1)));
}

}  // namespace

std::vector<std::uint32_t> selected_instances(const Forest& forest, const Selection& selection) {
  std::vector<std::uint32_t> chosen = selection.instances;
  for (std::size_t k = 0; k < chosen.size(); ++k)
    if (chosen[k] >= forest.instances.size())
      throw_invalid(field("instances", k), "there is no instance " + std::to_string(chosen[k]),
                    "an index below " + std::to_string(forest.instances.size()));
  add_trees(forest, selection.trees, chosen);
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  if (std::all_of(chosen.begin(), chosen.end(), [&](std::uint32_t i) {
        return forest.prototypes[forest.instances[i].prototype.value].foliage.empty();
      }))
    throw_invalid("selection", "holds no foliage, so there is nothing to light", "trees with leaves");
  return chosen;
}

Forest selected_forest(const Forest& forest, const Selection& selection) {
  Forest selected = forest;
  selected.instances.clear();
  for (const std::uint32_t i : selected_instances(forest, selection))
    selected.instances.push_back(forest.instances[i]);
  return selected;
}

LightMap selected_light(const LightMap& whole, const ForestIndex& index, const Forest& selected,
                        const std::vector<std::uint32_t>& instances, const OpticsRequest& optics) {
  SUNFLECK_EXPECTS(selected.instances.size() == instances.size());
  LightMap map;
  map.provenance = whole.provenance;
  copy_part(whole.sunlit_fraction, index, instances, map.sunlit_fraction);
  for (const BandLightMap& from : whole.bands) {
    BandLightMap& band = map.bands.emplace_back();
    band.band = from.band;
    copy_part(from.elements, index, instances, band.elements);
    copy_part(from.standard_error_w_m2, index, instances, band.standard_error_w_m2);
    for (std::uint32_t k = 0; k < instances.size(); ++k) {
      band.trees.push_back(from.trees[instances[k]]);
      band.trees.back().instance = k;
    }
  }
  summarize(selected, ForestIndex(selected), OpticsTable(selected, optics), map);
  return map;
}

}  // namespace sunfleck
