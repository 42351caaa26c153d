// Outlines and veins of leaves for pictures: light is computed for the flat element (a rhombus, square or
// disc), a picture shows a leaf of the same area, axis and aspect.
//
// Leaf coordinates: x along the leaf from its base (-1) to its tip (1), y across from edge to edge of the
// box that holds the outline (-1 to 1, y > 0 on the left seen from the front with the tip ahead).
#pragma once

#include <string>

#include "sim/base/vec.h"

namespace sunfleck {

enum class LeafOutline {
  kBySpecies,   // by the material's latin name, see outline_of
  kAsModelled,  // the element itself
  kOvate,       // egg-shaped with a point and a stalk: beech, birch
  kLobed,       // round lobes, widest above the middle: oak
  kNeedle       // long, with parallel edges: single needles
};
std::string to_string(LeafOutline outline);  // "by_species", "as_modelled", "ovate", "lobed", "needle"

// Of a material named by species: Quercus lobed; Pinus, Picea, Abies, Larix, Pseudotsuga needle; else ovate.
LeafOutline outline_of(const std::string& material);

// Whether a place of the box belongs to the leaf. Not for kBySpecies; everything does for kAsModelled.
bool inside_leaf(LeafOutline outline, const Vec2& at);
// Area of the outline over that of its box; by the midpoint rule, to 1e-5.
double outline_share(LeafOutline outline);
// Length over width, for elements that show none of their own (squares, discs).
double natural_aspect(LeafOutline outline);

// How much a place reflects and how much it lets through, relative to the leaf's mean: ribs are lighter and
// thicker than the blade. Means over the outline are 1, to 1e-4.
struct LeafPattern {
  double reflect = 1, pass = 1;
};
LeafPattern vein_pattern(LeafOutline outline, const Vec2& at);

}  // namespace sunfleck
