// Planting rules -> trees.
#pragma once

#include <string>
#include <vector>

#include "sim/base/run_control.h"
#include "sim/forest/forest_spec.h"

namespace sunfleck {

struct PlantedTrees {
  std::vector<InventoryTree> trees;     // numbered from 1 in the order of the rules
  std::vector<std::string> shortfalls;  // one sentence per rule whose trees did not all fit
};

// Plants the rules in their order on [0, width] x [0, depth]; later rules keep their distance from all trees
// that are there. Deterministic in (planting, seed, plot). Throws Error(kInvalidInput) for a rule that makes
// no sense, kLimitExceeded for more than kMostPlantedTrees.
inline constexpr std::size_t kMostPlantedTrees = 10'000'000;
PlantedTrees plant_trees(const ForestSpec& spec, const RunControl& control);

}  // namespace sunfleck
