// What is known of a forest without its leaves and wood: where its trees stand and what boxes they fill.
// Enough to tell which trees a picture needs before they are read.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/forest/forest.h"

namespace sunfleck {

// What holds a prototype however it is turned, and what is in it.
struct PrototypeOutline {
  Box bounds;                 // prototype_bounds; empty: nothing is in it
  double reach_m = 0;         // prototype_reach_m
  double longest_leaf_m = 0;  // largest 2 (|half_u| + |half_v|) of its foliage elements
  std::uint64_t foliage_elements = 0;
};
PrototypeOutline outline_of(const Prototype& prototype);

struct ForestOutline {
  std::vector<PrototypeOutline> prototypes;
  std::vector<Instance> instances;
  Terrain terrain;
  std::optional<Period> period;
};
ForestOutline outline_of(const Forest& forest);

// Box of an instance as forest_bounds takes it: of the turned and moved box of its prototype the part within
// the cylinder round the stem axis. Empty where the prototype is.
Box instance_box(const Instance& instance, const PrototypeOutline& outline);
std::vector<Box> instance_boxes(const ForestOutline& forest);

// SHA-256 of parts of a forest, to check what was read of it.
std::string content_hash(const Prototype& prototype);
std::string content_hash(const std::vector<Instance>& instances);

}  // namespace sunfleck
