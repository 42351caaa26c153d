// The steps of grow_forest: trees with their species in, prototypes and instances out.
#pragma once

#include <vector>

#include "sim/forest/forest_spec.h"

namespace sunfleck {

struct StandTree {
  InventoryTree tree;
  const Species* species = nullptr;  // of the library that grow_forest was given
};

// One prototype per tree, its measured crown filled with leaves; radii point where they were measured (yaw
// 0).
void grow_crowns(const ForestSpec& spec, const std::vector<StandTree>& stand, const RunControl& control,
                 Forest& forest);

// Shared prototypes by the species' grammar. Throws for a species without grammar.
void grow_lsystems(const ForestSpec& spec, const std::vector<StandTree>& stand, const RunControl& control,
                   Forest& forest);

// Where a tree stands: on the terrain.
Vec3 stem_foot_m(const Terrain& terrain, const InventoryTree& tree);

inline constexpr const char* kGrowingStage = "growing trees";

}  // namespace sunfleck
