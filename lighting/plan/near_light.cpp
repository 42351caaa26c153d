#include "lighting/plan/near_light.h"

#include <algorithm>
#include <cstdio>

#include "lighting/base/summaries.h"
#include "lighting/plan/light_session.h"
#include "lighting/trace/kept_rays.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

// Looking for them costs a quarter of a million paths: about what `reference` takes for this many leaves.
constexpr std::size_t kFewestTrees = 16, kFewestElements = 30'000;
// Below this share of the leaves the whole forest costs hardly more.
constexpr double kWorthwhile = 0.2;

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %%", 100 * share);
  return text;
}

double share_of_leaves(const ForestIndex& index, const std::vector<std::uint32_t>& trees) {
  std::size_t elements = 0;
  for (const std::uint32_t i : trees) elements += index.first_element(i + 1) - index.first_element(i);
  return static_cast<double>(elements) / static_cast<double>(index.element_count());
}

FarTrees find(const LightScene& scene, const LightRequest& request, const RunControl& control) {
  const OpticsTable optics(scene.forest, request.optics);
  const Illumination light = checked(request.light, optics.band_count());
  const trace::KeptRays kept(scene.forest, scene.store, control);
  FarTreesOptions options;
  options.most_change = request.selection.far_trees_share * request.automatic.aim();
  options.seed = request.reference.seed;
  return find_far_trees(ProbeScene(kept, request.reference.ground), optics, light,
                        selected_instances(scene.forest, request.selection), options, control);
}

Forest without(const Forest& forest, const FarTrees& trees) {
  Forest rest = forest;
  rest.instances.clear();
  for (const std::uint32_t i : trees.near) rest.instances.push_back(forest.instances[i]);
  return rest;
}

// The same trees by their indexes in the forest that is left.
LightRequest renumbered(const LightRequest& request, const std::vector<std::uint32_t>& selected,
                        const FarTrees& trees) {
  LightRequest there = request;
  there.selection = {};
  there.selection.far_trees_share = 0;
  for (std::uint32_t k = 0; k < trees.near.size(); ++k)
    if (std::binary_search(selected.begin(), selected.end(), trees.near[k]))
      there.selection.instances.push_back(k);
  return there;
}

void tell(const LightScene& scene, const FarTrees& trees, std::size_t selected, LightMap& map) {
  Provenance& p = map.provenance;
  const std::string all = std::to_string(scene.forest.instances.size());
  p.forest_hash = scene.forest_hash;
  p.skipped.insert(
      p.skipped.begin(),
      {std::to_string(trees.far.size()) + " of " + all + " trees, far from those asked for",
       "by " + std::to_string(trees.paths) + " traced paths the selected trees' leaves change by " +
           percent(trees.bound) + " (RMS) of their mean at most, 99 % sure",
       trees.bound});
  for (auto& [name, value] : p.settings)
    if (name == "selection") value = std::to_string(selected) + " of " + all + " trees";
}

}  // namespace

bool may_leave_trees_out(const LightScene& scene, const LightRequest& request) {
  return !request.selection.everything() && request.skip == Skipping::kAuto &&
         request.selection.far_trees_share > 0 && request.method != Method::kWorld &&
         scene.forest.instances.size() >= kFewestTrees && scene.index.element_count() >= kFewestElements;
}

std::optional<LightMap> near_trees_light(const LightScene& scene, const LightRequest& request,
                                         const CostOptions& cost, const RunControl& control) {
  Provenance looking;
  FarTrees trees;
  {
    const StageTimer timer(looking, "finding far trees");
    with_threads(scene.threads, [&] { trees = find(scene, request, control); });
  }
  if (share_of_leaves(scene.index, trees.far) < kWorthwhile) return std::nullopt;
  const std::vector<std::uint32_t> selected = selected_instances(scene.forest, request.selection);
  const Forest rest = without(scene.forest, trees);
  const LightSession session(rest);
  LightMap map = session.compute(renumbered(request, selected, trees), cost, control);
  tell(scene, trees, selected.size(), map);
  map.provenance.times.insert(map.provenance.times.begin(), looking.times.begin(), looking.times.end());
  return map;
}

}  // namespace sunfleck
