// The light map of a forest of which only some prototypes were loaded.
#pragma once

#include <vector>

#include "lighting/base/light_map.h"
#include "sim/forest/forest_outline.h"

namespace sunfleck {

// `map` numbers the elements of the whole forest (ForestIndex order); the result those of the forest whose
// prototypes with loaded[p] == 0 are empty. Sums per tree and budgets stay those of the whole. Throws
// Error(kInvalidInput) where the map is not of that forest's size.
LightMap light_of_loaded(LightMap map, const ForestOutline& whole, const std::vector<char>& loaded);

}  // namespace sunfleck
