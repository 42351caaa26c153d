// TreeSource::kCrown: every tree its own prototype. Memory is 44 bytes per foliage element of every tree.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"
#include "sim/forest/crown_filling.h"
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

bool is_grown(const ForestSpec& spec, const StandTree& entry) {
  return spec.filling == CrownFilling::kGrown && !entry.species->grammar.empty();
}

Prototype grown(const StandTree& entry, const CrownShape& crown, const CrownFill& fill,
                const RunControl& control) {
  try {
    return grown_crown(*entry.species, crown, fill.leaf_area_m2, fill.elements, fill.seed, control);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::kCancelled) throw;
    throw Error(error.kind(), tree_label(entry.tree) + ": " + error.where(), error.problem(), error.remedy());
  }
}

Prototype crown_of(const ForestSpec& spec, const StandTree& entry, const RunControl& control) {
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
  fill.height_power = spec.height_power;
  fill.branch_share = spec.branch_share;
  fill.seed = mix_seed(spec.seed, entry.tree.id.value);
  Prototype prototype = is_grown(spec, entry) ? grown(entry, crown, fill, control)
                                              : crown_prototype(*entry.species, crown, fill);
  prototype.name = entry.species->latin + " " + std::to_string(entry.tree.id.value);
  return prototype;
}

std::string count_of(std::size_t trees) { return std::to_string(trees) + (trees == 1 ? " tree" : " trees"); }

void say_what_was_grown(const ForestSpec& spec, const std::vector<StandTree>& stand, const Forest& forest,
                        std::vector<std::string>& notes) {
  if (spec.filling != CrownFilling::kGrown) return;
  std::map<std::string, std::size_t> without;
  std::size_t trees = 0, elements = 0, segments = 0;
  for (std::size_t i = 0; i < stand.size(); ++i) {
    if (!is_grown(spec, stand[i])) {
      ++without[stand[i].species->latin];
      continue;
    }
    ++trees;
    elements += forest.prototypes[i].foliage.size();
    segments += forest.prototypes[i].wood.size();
  }
  for (const auto& [latin, count] : without)
    notes.push_back(latin + " has no grammar: its crowns (" + count_of(count) + ") were filled with leaves");
  if (trees == 0) return;
  char text[200];
  std::snprintf(
      text, sizeof text,
      "%s grown into their crowns, none shared: %zu elements and %zu pieces of wood, %.0f MB",
      count_of(trees).c_str(), elements, segments,
      1e-6 * static_cast<double>(elements * sizeof(FoliageElement) + segments * sizeof(WoodSegment)));
  notes.push_back(text);
}

}  // namespace

void grow_crowns(const ForestSpec& spec, const std::vector<StandTree>& stand, const RunControl& control,
                 Forest& forest, std::vector<std::string>& notes) {
  check_elements(spec, stand.size());
  forest.prototypes.resize(stand.size());
  const RunControl stop_only{control.stop, {}};  // progress is counted in trees
  for_each_chunk(stand.size(), 1, control, kGrowingStage, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) forest.prototypes[i] = crown_of(spec, stand[i], stop_only);
  });
  say_what_was_grown(spec, stand, forest, notes);
  for (std::size_t i = 0; i < stand.size(); ++i) {
    const InventoryTree& tree = stand[i].tree;
    const PrototypeId prototype{static_cast<std::uint32_t>(i)};
    forest.instances.push_back({stem_foot_m(forest.terrain, tree), prototype, 0.0F, 1.0F, tree.id});
  }
}

}  // namespace sunfleck
