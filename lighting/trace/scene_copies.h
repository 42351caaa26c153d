// Where the prototypes stand in a ray scene: every instance once, or in a periodic forest every copy of it
// whose box reaches into the base cell.
#pragma once

#include <span>
#include <vector>

#include "lighting/trace/embree_scene.h"
#include "lighting/trace/ray_walk.h"

namespace sunfleck::trace {

// Ground, period and the heights between which there is something to hit, around `centre_m`.
Surroundings surroundings_of(const Forest& forest, const RayScene::Options& options, const Vec3& centre_m);

// The prototypes of a forest's instances.
std::vector<PrototypeId> own_prototypes(const Forest& forest);

// Of everything there is to hit where `cast[i]` stands in the place of instance i; which figures they are
// made of is left to the builders.
std::vector<SceneCopy> copies_of(const Forest& forest, std::span<const PrototypeId> cast,
                                 const Surroundings& around, const Vec3& centre_m);

// Figures of all copies together.
std::size_t figures_of(const Forest& forest, const std::vector<SceneCopy>& copies);

// Writes every copy out into one scene and commits it: `placed` takes the figures of each, the copies point
// there.
SceneHandle build_flat_scene(const Device& device, const Forest& forest, std::vector<SceneCopy>& copies,
                             std::vector<PrototypeScene>& placed, const Surroundings& around,
                             const Vec3& centre_m, const RayScene::Options& options,
                             const RunControl& control);

// Commits a scene with one Embree instance per copy, in their order.
SceneHandle build_top_scene(const Device& device, const Forest& forest, std::vector<SceneCopy>& copies,
                            const std::vector<PrototypeScene>& prototypes, const Surroundings& around,
                            const Vec3& centre_m, const RunControl& control);

}  // namespace sunfleck::trace
