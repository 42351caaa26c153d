// How unevenly the leaves of a tree are spread at the scale of a cell. Pairs of leaves in one cell tell it:
// where leaves are spread evenly, cells twice as wide hold eight times the neighbours of a leaf; where they
// stand in clumps not much wider than a cell, or in sheets and lines, fewer (the correlation sum of
// Grassberger and Procaccia 1983 at two scales).
#pragma once

#include "sim/forest/forest.h"

namespace sunfleck::transport {

// 8 times the mean number of other leaves in a leaf's cell over that in cells twice as wide: about 1.03 for
// balls and cones of random leaves at extent / 32 (cells at the border are half empty), 1.1 for a shell, 1.3
// for 120 clumps of 0.12 radii in a ball, 1.5 to 2 for trees of the grammars. 1 where fewer than
// kFewestPairs pairs share a cell: too few to tell.
// `cell_m` > 0 and at least extent / 256.
double leaf_clumping(const Prototype& prototype, double cell_m);

inline constexpr double kFewestPairs = 100;

}  // namespace sunfleck::transport
