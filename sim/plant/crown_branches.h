// The branches of a crown prototype, as far as light notices them: their surface and where it is.
//
// A beech or oak carries most of the surface of its wood in twigs a finger thick, and they are where its
// leaves are. So branches are drawn as short tapered rods of about that girth whose tips are spread as the
// leaves are, each pointing away from the stem and upwards at 45 degrees. They are not connected: stem, order
// and shape of real branches need a grammar (grow_prototype).
#pragma once

#include <vector>

#include "sim/plant/make_prototype.h"

namespace sunfleck {

// Rods whose half surface adds up to fill.branch_share * fill.leaf_area_m2 (less what reached into the
// ground); none for a share of 0. Seeds as the leaves.
std::vector<WoodSegment> crown_branches(const CrownShape& crown, const CrownFill& fill);

}  // namespace sunfleck
