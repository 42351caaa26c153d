// Fits a grown tree to its size: grammars come close, this takes up the rest.
#pragma once

#include "sim/plant/make_prototype.h"

namespace sunfleck {

// Moves foliage centres and wood: horizontally by one factor, vertically by one below and one above the crown
// base, so that height, crown base and crown radius are those of `size`. Elements keep size and orientation.
// Outer parts that droop far below the crown base are lifted first. Assumes an upright tree.
void reshape_to_size(Prototype& prototype, const TreeSize& size);

}  // namespace sunfleck
