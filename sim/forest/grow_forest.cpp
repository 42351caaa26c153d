// Trees (inventory or planted) -> their species -> prototypes and instances -> a forest that is valid.

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "sim/base/error.h"
#include "sim/base/random.h"
#include "sim/forest/forest_spec.h"
#include "sim/forest/planting.h"
#include "sim/forest/stand.h"
#include "sim/forest/surroundings.h"
#include "sim/forest/tree_size.h"
#include "sim/forest/understorey.h"

namespace sunfleck {

namespace {

std::vector<InventoryTree> trees_of(const ForestSpec& spec, const SpeciesLibrary& species,
                                    const RunControl& control, std::vector<std::string>& notes) {
  if (!spec.inventory.empty() && !spec.planting.empty()) {
    throw_invalid("forest", "there are an inventory and planting rules", "give one of them");
  }
  if (!spec.inventory.empty()) {
    std::vector<InventoryTree> trees = spec.inventory;
    if (spec.understorey.add) {
      const PlotPolygon plot = spec.plot ? *spec.plot : plot_around(trees);
      const std::vector<InventoryTree> small =
          understorey_trees(trees, plot, spec.understorey, species, mix_seed(spec.seed, 78), notes);
      trees.insert(trees.end(), small.begin(), small.end());
    }
    return trees;
  }
  if (spec.planting.empty()) {
    throw_invalid("forest", "there are no trees", "give an inventory or planting rules");
  }
  PlantedTrees planted = plant_trees(spec, control);
  notes.insert(notes.end(), planted.shortfalls.begin(), planted.shortfalls.end());
  return std::move(planted.trees);
}

// Adds what stands around the plot; sets the period of a stand that repeats.
std::vector<InventoryTree> with_surroundings(const ForestSpec& spec, std::vector<InventoryTree> trees,
                                             Forest& forest, std::vector<std::string>& notes) {
  if (spec.surroundings == Surroundings::kNone) return trees;
  if (spec.period)
    throw_invalid("forest.period", "the stand has surroundings already", "give period or surroundings");
  const PlotPolygon plot = spec.plot ? *spec.plot : plot_around(trees);
  SurroundedStand stand =
      surround(trees, plot, spec.surroundings, spec.surroundings_width_m, mix_seed(spec.seed, 77));
  if (stand.period) forest.period = stand.period;
  notes.insert(notes.end(), stand.notes.begin(), stand.notes.end());
  return std::move(stand.trees);
}

// Trees that look like another one are instances of its prototype.
void place_copies(const std::vector<StandTree>& copies, Forest& forest) {
  std::map<TreeId, Instance> originals;
  for (const Instance& instance : forest.instances) originals.emplace(instance.tree, instance);
  for (const StandTree& copy : copies) {
    const auto original = originals.find(*copy.tree.copy_of);
    if (original == originals.end()) continue;  // it died for want of light
    Instance instance = original->second;
    instance.position_m = stem_foot_m(forest.terrain, copy.tree);
    instance.yaw_rad += static_cast<float>(copy.tree.copy_yaw_rad);
    instance.tree = copy.tree.id;
    forest.instances.push_back(instance);
  }
}

std::vector<StandTree> take_copies(std::vector<StandTree>& stand) {
  const auto first =
      std::stable_partition(stand.begin(), stand.end(), [](const StandTree& s) { return !s.tree.copy_of; });
  std::vector<StandTree> copies(first, stand.end());
  stand.erase(first, stand.end());
  return copies;
}

std::vector<StandTree> stand_of(std::vector<InventoryTree> trees, const SpeciesLibrary& library) {
  std::vector<StandTree> stand;
  std::set<TreeId> ids;
  for (InventoryTree& tree : trees) {
    validate(tree);
    if (!ids.insert(tree.id).second) {
      throw_invalid(tree_label(tree), "another tree has this number", "give each tree its own number");
    }
    const Species& species = library.find(tree.species, tree_label(tree));
    if (tree.form == TreeForm::kOpenGrown && !species.open_grown)
      throw_invalid(tree_label(tree), "nothing is known of open-grown trees of " + species.latin,
                    "form = \"stand\", or an [open_grown] table in the species' file");
    stand.push_back({std::move(tree), &species});
  }
  if (stand.empty()) throw_invalid("forest", "no tree fits", "a larger plot or a smaller spacing");
  return stand;
}

std::vector<Material> materials_of(const std::vector<StandTree>& stand) {
  std::map<std::string, Material> by_name;
  for (const StandTree& entry : stand) by_name.emplace(entry.species->material.name, entry.species->material);
  std::vector<Material> materials;
  for (const auto& [name, material] : by_name) materials.push_back(material);
  return materials;
}

}  // namespace

PlotPolygon plot_around(const std::vector<InventoryTree>& trees) {
  Vec2 lo(INFINITY), hi(-INFINITY);
  for (const InventoryTree& tree : trees) {
    lo = glm::min(lo, Vec2(tree.x_m, tree.y_m));
    hi = glm::max(hi, Vec2(tree.x_m, tree.y_m));
  }
  const double n = std::sqrt(static_cast<double>(trees.size()));
  const Vec2 margin = 0.5 * (hi - lo) / std::max(n - 1, 1.0) + 1e-3;
  return rectangle(lo - margin, hi + margin);
}

Vec3 stem_foot_m(const Terrain& terrain, const InventoryTree& tree) {
  return {tree.x_m, tree.y_m, terrain.height_at(tree.x_m, tree.y_m)};
}

Forest grow_forest(const ForestSpec& spec, const SpeciesLibrary& species, const RunControl& control,
                   std::vector<std::string>* notes, const GrowthLightMaker& grid_light) {
  std::vector<std::string> said;
  Forest forest;
  forest.name = spec.name;
  forest.terrain = spec.terrain;
  forest.period = spec.period;
  validate(forest);  // ground and period, before anything costs time
  std::vector<StandTree> stand =
      stand_of(with_surroundings(spec, trees_of(spec, species, control, said), forest, said), species);
  const std::vector<StandTree> copies = take_copies(stand);
  forest.materials = materials_of(stand);
  switch (spec.trees) {
    case TreeSource::kCrown:
      if (spec.grow_in_light)
        throw_invalid("forest.grow_in_light", "is for trees of grammars", "trees = \"lsystem\"");
      grow_crowns(spec, stand, control, forest, said);
      break;
    case TreeSource::kLsystem:
      if (spec.grow_in_light)
        grow_stand_in_light(spec, stand, grid_light, control, forest, said);
      else
        grow_lsystems(spec, stand, control, forest, said);
      break;
  }
  place_copies(copies, forest);
  validate(forest);
  if (notes != nullptr) notes->insert(notes->end(), said.begin(), said.end());
  return forest;
}

}  // namespace sunfleck
