// Trees (inventory or planted) -> their species -> prototypes and instances -> a forest that is valid.

#include <map>
#include <set>

#include "sim/base/error.h"
#include "sim/forest/forest_spec.h"
#include "sim/forest/planting.h"
#include "sim/forest/stand.h"
#include "sim/forest/tree_size.h"

namespace sunfleck {

namespace {

std::vector<InventoryTree> trees_of(const ForestSpec& spec, const RunControl& control,
                                    std::vector<std::string>& notes) {
  if (!spec.inventory.empty() && !spec.planting.empty()) {
    throw_invalid("forest", "there are an inventory and planting rules", "give one of them");
  }
  if (!spec.inventory.empty()) return spec.inventory;
  if (spec.planting.empty()) {
    throw_invalid("forest", "there are no trees", "give an inventory or planting rules");
  }
  PlantedTrees planted = plant_trees(spec, control);
  notes.insert(notes.end(), planted.shortfalls.begin(), planted.shortfalls.end());
  return std::move(planted.trees);
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

Vec3 stem_foot_m(const Terrain& terrain, const InventoryTree& tree) {
  return {tree.x_m, tree.y_m, terrain.height_at(tree.x_m, tree.y_m)};
}

Forest grow_forest(const ForestSpec& spec, const SpeciesLibrary& species, const RunControl& control,
                   std::vector<std::string>* notes) {
  std::vector<std::string> said;
  Forest forest;
  forest.name = spec.name;
  forest.terrain = spec.terrain;
  forest.period = spec.period;
  validate(forest);  // ground and period, before anything costs time
  const std::vector<StandTree> stand = stand_of(trees_of(spec, control, said), species);
  forest.materials = materials_of(stand);
  switch (spec.trees) {
    case TreeSource::kCrown:
      grow_crowns(spec, stand, control, forest);
      break;
    case TreeSource::kLsystem:
      grow_lsystems(spec, stand, control, forest, said);
      break;
  }
  validate(forest);
  if (notes != nullptr) notes->insert(notes->end(), said.begin(), said.end());
  return forest;
}

}  // namespace sunfleck
