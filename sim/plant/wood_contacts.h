// Where the wood of one tree runs into itself: twigs and boughs that cross, apart from forks, where wood
// meets because it has grown so.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/plant/prototype.h"

namespace sunfleck {

struct WoodContact {
  std::size_t first, second;  // indexes of the segments, first < second
  double overlap_m;           // sum of the radii where they are nearest, less the distance of their axes
};

// Pairs of segments that overlap by more than tolerance * the smaller radius, ordered. `parents` are the
// indexes of the segments below (-1 at the root), parents before children. A pair does not count while it is
// nearer to the fork its branches come from than four times the wood's radius there and a centimetre: so far
// two limbs, or the limb and the stem, are one piece of wood. About linear in the number of segments for wood
// as sparse as in crowns.
std::vector<WoodContact> wood_contacts(std::span<const WoodSegment> wood,
                                       std::span<const std::int32_t> parents, double tolerance);

// True for the segments to take away so that no contact is left: of each pair the thinner one and everything
// that grows on it.
std::vector<bool> crossing_branches(std::span<const WoodSegment> wood, std::span<const std::int32_t> parents,
                                    double tolerance);

// Parents of connected wood: the first segment, of those before, that ends exactly where this one begins; -1
// if none does.
std::vector<std::int32_t> wood_parents(std::span<const WoodSegment> wood);

}  // namespace sunfleck
