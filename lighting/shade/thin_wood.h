// Twigs of far trees: a segment thinner than a width is kept with a chance of its own width over that width,
// and drawn that wide. So nothing is thinner, the outline of all wood keeps its area in the mean, and a tree
// of ten thousand twigs is left with a few hundred. Segments that are wider stay as they are.
//
// Which segments stay is drawn one by one from (seed, index) alone, so those kept at a width are among those
// kept at any smaller one: levels nest as pruned leaves do (prune.h). Right while the width is well below a
// pixel. Not for light maps.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/plant/prototype.h"

namespace sunfleck {

// width_m >= 0, the diameter; a segment's own is the mean of its ends. A tapered segment keeps its taper.
// Segments without radius go. Throws Error(kInvalidInput) for a width that is negative or not finite.
std::vector<WoodSegment> thin_wood(std::span<const WoodSegment> wood, double width_m, std::uint64_t seed);

}  // namespace sunfleck
