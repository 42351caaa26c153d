// What the geometry of one tree of an inventory shall measure: its row where it was measured, the allometry
// of its species where it was not.
#pragma once

#include <string>

#include "sim/forest/forest_spec.h"
#include "sim/plant/make_prototype.h"

namespace sunfleck {

// "trees.csv:12: tree 209 (Quercus robur)", for error messages; without the row if it came from no file.
std::string tree_label(const InventoryTree& tree);

// Throws Error(kInvalidInput) naming the tree if a measure is not finite or out of range (rows can come from
// requests, not only from files).
void validate(const InventoryTree& tree);

double tree_height_m(const InventoryTree& tree, const Species& species);

// Missing: base by the species' crown ratio; widest at a third of the crown's length above its base; a radius
// as the mean of those that are measured, else by allometry. A side without crown (radius 0) counts as 1 cm.
// Throws where the row and allometry give no crown.
CrownShape tree_crown(const InventoryTree& tree, const Species& species);

// Leaf area density times crown volume if the density is known, else by allometry; throws if there is none.
double tree_leaf_area_m2(const InventoryTree& tree, const Species& species, const CrownShape& crown);

// True if the row states more of the tree's size than its DBH.
bool is_measured(const InventoryTree& tree);

// The size of a measured tree for a grammar: crown radius is the mean of the four; a crown that reaches the
// ground begins at a hundredth of the height.
TreeSize tree_size(const InventoryTree& tree, const Species& species);

}  // namespace sunfleck
