// How much of a leaf's view its closest neighbours fill: what a light field that is smooth over cells of a
// few leaves cannot know of the single leaf. From geometry alone, of the tree by itself.
//
// A neighbour of area A at distance r fills of a face the share A cos cos / (pi r^2 + A), that of a disc seen
// from the middle of the leaf (exact where both face each other); several fill 1 - exp(-sum), as if thrown at
// random. Neighbours are those whose middles lie within kCloseSides mean leaf sides; wood and other trees are
// left out. A shoot's needles face everywhere: a neighbour's share counts by a quarter on each of its faces,
// and it turns half of its needle area to every side.
#pragma once

#include <vector>

#include "sim/base/run_control.h"
#include "sim/forest/forest.h"

namespace sunfleck {

inline constexpr double kCloseSides = 2.0;

// Sum over both faces, 0 to 2, of every foliage element of a prototype. Where very many leaves share a place
// (kMostInRow and more in three cells of a row), a part of them stands for all.
std::vector<float> close_cover(const Prototype& prototype, const RunControl& control);
inline constexpr std::size_t kMostInRow = 256;

// The same, of every element of a forest, ForestIndex order.
std::vector<float> close_cover(const Forest& forest, const RunControl& control);

// The same of one element, by looking at all others: the plain twin.
double close_cover_plain(const Prototype& prototype, std::size_t element);

}  // namespace sunfleck
