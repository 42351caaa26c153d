// TreeSource::kCrown: every tree its own prototype. Memory is 44 bytes per foliage element of every tree.

#include <algorithm>
#include <cmath>

#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"
#include "sim/forest/stand.h"
#include "sim/forest/tree_size.h"

namespace sunfleck {

namespace {

constexpr std::size_t kMostElements = 200'000'000;  // 8.8 GB

void check_elements(const ForestSpec& spec, std::size_t trees) {
  if (spec.elements_per_tree < 1) {
    throw_invalid("forest.elements_per_tree", "is " + std::to_string(spec.elements_per_tree), "1 or more");
  }
  const std::size_t total = static_cast<std::size_t>(spec.elements_per_tree) * trees;
  if (total <= kMostElements) return;
  throw Error(
      ErrorKind::kLimitExceeded, "forest.elements_per_tree",
      std::to_string(total) + " foliage elements in all are too many",
      "at most " + std::to_string(kMostElements) + ": fewer elements per tree, or trees = \"lsystem\"");
}

constexpr int kLeastElements = 20;

double leaf_area_of(const ForestSpec& spec, const StandTree& entry, const CrownShape& crown) {
  const double area_m2 = spec.leaf_area == LeafAreaSource::kAllometry
                             ? entry.species->leaf_area_m2(entry.tree.dbh_cm, crown.height_m)
                             : tree_leaf_area_m2(entry.tree, *entry.species, crown);
  return spec.leaf_area_factor * area_m2;
}

Prototype crown_of(const ForestSpec& spec, const StandTree& entry) {
  const CrownShape crown = tree_crown(entry.tree, *entry.species);
  CrownFill fill;
  fill.leaf_area_m2 = leaf_area_of(spec, entry, crown);
  fill.elements = spec.elements_per_tree;
  if (spec.element_area_m2 > 0)
    fill.elements = static_cast<int>(std::clamp(std::round(fill.leaf_area_m2 / spec.element_area_m2),
                                                1.0 * kLeastElements, 1.0 * kMostElements));
  fill.clump_radius_m = spec.clumps.radius_m;
  fill.clump_elements = spec.clumps.elements;
  if (spec.clumps.leaf_area_m2 > 0)
    fill.clump_elements = static_cast<int>(
        std::clamp(std::round(spec.clumps.leaf_area_m2 * fill.elements / fill.leaf_area_m2), 1.0, 1e6));
  fill.rim_power = spec.rim_power;
  fill.branch_share = spec.branch_share;
  fill.seed = mix_seed(spec.seed, entry.tree.id.value);
  Prototype prototype = crown_prototype(*entry.species, crown, fill);
  prototype.name = entry.species->latin + " " + std::to_string(entry.tree.id.value);
  return prototype;
}

}  // namespace

void grow_crowns(const ForestSpec& spec, const std::vector<StandTree>& stand, const RunControl& control,
                 Forest& forest) {
  check_elements(spec, stand.size());
  forest.prototypes.resize(stand.size());
  for_each_chunk(stand.size(), 1, control, kGrowingStage, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) forest.prototypes[i] = crown_of(spec, stand[i]);
  });
  for (std::size_t i = 0; i < stand.size(); ++i) {
    const InventoryTree& tree = stand[i].tree;
    const PrototypeId prototype{static_cast<std::uint32_t>(i)};
    forest.instances.push_back({stem_foot_m(forest.terrain, tree), prototype, 0.0F, 1.0F, tree.id});
  }
}

}  // namespace sunfleck
