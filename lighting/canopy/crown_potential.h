// What each tree would intercept alone in the open, direction by direction: rays over the rectangle that
// holds the tree, through nothing but the tree.
#pragma once

#include <cstdint>
#include <vector>

#include "lighting/canopy/light_weights.h"
#include "lighting/canopy/response_table.h"
#include "lighting/canopy/stand_scene.h"

namespace sunfleck {

// m2 of facing light per instance, leaves and wood. `rays` per direction and tree; 0 skips the direction.
// Trees of surroundings (StandScene::is_asked) stay at 0. Errors by the mean worth of a ray over the trees.
ResponseTable crown_potential(const StandScene& scene, const LightSource& source,
                              const std::vector<int>& rays, std::uint64_t seed, const RunControl& control);

}  // namespace sunfleck
