// Light on a few selected trees, computed in the part of the forest that matters for them (far_trees.h).
#pragma once

#include <optional>

#include "lighting/plan/far_trees.h"
#include "lighting/plan/light_request.h"
#include "lighting/plan/light_scene.h"

namespace sunfleck {

// Whether looking for far trees may pay: a selection, skipping allowed, a share above 0, and enough else in
// the forest. Never for the world method, which solves the whole forest once for any selection.
bool may_leave_trees_out(const LightScene& scene, const LightRequest& request);

// nullopt: nothing worth leaving out, compute with the whole forest. Else the light map of the selection, of
// a forest without its far trees, with a skip note that says how many and the bound; the share of the
// tolerance is Selection::far_trees_share of AutoOptions::aim(), whatever the method.
std::optional<LightMap> near_trees_light(const LightScene& scene, const LightRequest& request,
                                         const CostOptions& cost, const RunControl& control);

}  // namespace sunfleck
