// Very many trees as one Embree geometry: a row of 24 bytes for each instead of the 361 bytes of an Embree
// instance, and 28 bytes or so of its hierarchy. A ray that meets the box of a tree is taken into the tree's
// coordinates and goes on in the scene of its prototype, as Embree's own instances do it.
//
// With the 40 bytes of Instance a tree costs less than 100 bytes. For forests that do not repeat.
// Private to this folder; include <embree3/rtcore.h> first.
#pragma once

#include <cstddef>
#include <vector>

#include "lighting/trace/embree_scene.h"

namespace sunfleck::trace {

// Place of a tree in the scene's coordinates, and its turn and scale undone: tree = R (scene - place), with
// R = (c, s; -s, c) / scale in x and y. Single precision, as Embree's own transforms.
struct TreeRow {
  Vec3f place_m;
  float cos_by_scale, sin_by_scale, one_by_scale;
};
static_assert(sizeof(TreeRow) == 24);

struct InstanceTable {
  const Forest* forest = nullptr;
  const std::vector<PrototypeScene>* figures = nullptr;  // of each prototype
  std::vector<PrototypeId> prototypes;                   // of each instance, where they are not its own
  std::vector<Box> boxes;                                // of each prototype, in tree coordinates
  std::vector<double> reaches_m;                         // of each, round the stem axis
  std::vector<TreeRow> rows;                             // of each instance
  PrototypeId prototype_of(unsigned tree) const {
    return prototypes.empty() ? forest->instances[tree].prototype : prototypes[tree];
  }
};

// `prototypes`: of each instance; empty: its own. All else must outlive the table. Throws
// Error(kLimitExceeded) for more than 4 thousand million trees.
InstanceTable make_instance_table(const Forest& forest, const std::vector<PrototypeScene>& figures,
                                  const std::vector<PrototypeId>& prototypes, const Vec3& centre_m);

// The tree met, with the turn that is left to do to the normal of the hit.
SceneCopy copy_in_table(const InstanceTable& table, unsigned tree);

// Commits a scene of the table's trees; `table` must stay where it is. Hits carry the number of the tree as
// Embree's instance id.
SceneHandle build_table_scene(const Device& device, InstanceTable& table, const RunControl& control);

}  // namespace sunfleck::trace
