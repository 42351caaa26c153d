// Leaves for a tree of which only the wood is known (a QSM from a scan without leaves).
//
// Foliage sits on the twigs: on every last segment of a branch and on segments thinner than kTwigRadius_m, in
// proportion to their length, at a random side, a petiole's length away from the bark; normals follow the
// species' leaf angles. Nothing is known of the true leaves but their total area: light of the crown and its
// layers is meaningful, light of one such leaf is that of a typical leaf there.
#pragma once

#include <cstdint>

#include "sim/plant/prototype.h"
#include "sim/plant/species.h"

namespace sunfleck {

inline constexpr double kTwigRadius_m = 0.01;

struct LeavesOnWood {
  double leaf_area_m2 = 60;  // one-sided; met exactly, (0, 1e6]
  int elements = 10'000;     // 1 to 50 million; their size follows
  std::uint64_t seed = 1;
};
// Adds foliage of material 0. Throws Error(kInvalidInput): no wood, area or number out of range.
void attach_leaves(Prototype& tree, const Species& species, const LeavesOnWood& leaves);

}  // namespace sunfleck
