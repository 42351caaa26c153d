// The part of a forest that an answer is wanted for: the rest still shades and lights it.
#pragma once

#include <vector>

#include "lighting/base/light_map.h"
#include "lighting/optics/optics.h"
#include "sim/forest/forest.h"

namespace sunfleck {

// Trees by their inventory id (every instance that carries it) and instances by their index; both empty: all.
struct Selection {
  std::vector<TreeId> trees;
  std::vector<std::uint32_t> instances;
  // Of the tolerance: what leaving far trees out may change in the light on a selected tree, see far_trees.h;
  // [0, 1], 0: none is left out.
  double far_trees_share = 0.05;
  bool everything() const { return trees.empty() && instances.empty(); }
};

// Rising, each once. Throws Error(kInvalidInput) naming "selection.trees[i]" or "selection.instances[i]" for
// what is not there, "selection" for trees without foliage alone.
std::vector<std::uint32_t> selected_instances(const Forest& forest, const Selection& selection);

// The same forest with the selected instances only: what the elements and trees of a map of a selection are
// numbered by.
Forest selected_forest(const Forest& forest, const Selection& selection);

// A map of the whole forest cut down to these instances: TreeLight::instance counts the selected ones. Means
// are of what is left; their standard errors and the energy budget, which are of the whole, go.
LightMap selected_light(const LightMap& whole, const ForestIndex& index, const Forest& selected,
                        const std::vector<std::uint32_t>& instances, const OpticsRequest& optics);

}  // namespace sunfleck
