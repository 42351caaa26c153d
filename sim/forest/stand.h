// The steps of grow_forest: trees with their species in, prototypes and instances out.
#pragma once

#include <string>
#include <vector>

#include "sim/forest/forest_spec.h"

namespace sunfleck {

struct StandTree {
  InventoryTree tree;
  const Species* species = nullptr;  // of the library that grow_forest was given
};

// One prototype per tree, its measured crown filled with leaves; radii point where they were measured (yaw
// 0).
// Adds to `notes` which species have no grammar to fill crowns with, and what grown crowns take.
void grow_crowns(const ForestSpec& spec, const std::vector<StandTree>& stand, const RunControl& control,
                 Forest& forest, std::vector<std::string>& notes);

// Prototypes by the species' grammar: shared ones for trees known by their DBH only, one for each measured
// tree. Throws for a species without grammar. Adds to `notes` how many trees are not as tall as they should
// be.
void grow_lsystems(const ForestSpec& spec, const std::vector<StandTree>& stand, const RunControl& control,
                   Forest& forest, std::vector<std::string>& notes);

// spec.grow_in_light: all trees from seed, together; one prototype per tree. Stated sizes are not used. Trees
// that die are left out. Throws for a species without such a grammar, ground that slopes, and
// GrowthLight::kGrid without `grid_light`. Adds to `notes` what grew.
void grow_stand_in_light(const ForestSpec& spec, const std::vector<StandTree>& stand,
                         const GrowthLightMaker& grid_light, const RunControl& control, Forest& forest,
                         std::vector<std::string>& notes);

// Where a tree stands: on the terrain.
Vec3 stem_foot_m(const Terrain& terrain, const InventoryTree& tree);

inline constexpr const char* kGrowingStage = "growing trees";

}  // namespace sunfleck
