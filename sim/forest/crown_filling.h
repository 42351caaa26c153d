// A measured crown filled by a tree of its species' grammar: the tree is grown at the measured size, then its
// foliage and wood are moved into the crown's shape (base, widest height, four radii).
//
// The warp keeps stem and topology. Heights: lowest foliage to the crown's base, highest to the top, linear
// between and below. Then every point moves along its distance from the stem axis, so that the outline of the
// grown foliage (its farthest element by height and azimuth, 24 by 8 cells, smoothed outwards) becomes the
// measured outline at that height and azimuth. Foliage centres are inside the shape; elements may overhang it
// by their own size, as in crowns filled with leaves. Elements keep size, orientation and so their area; wood
// keeps its girth but for the stem, which has the DBH. Assumes an upright tree whose crown is one piece.
#pragma once

#include <string>
#include <vector>

#include "sim/forest/forest_spec.h"
#include "sim/plant/make_prototype.h"

namespace sunfleck {

// Distance of the crown's surface from the stem axis at a height, towards the unit direction (x east, y
// north); 0 above and below the crown.
double crown_reach_m(const CrownShape& crown, double height_m, const Vec2& towards);

// Moves a grown tree into the crown.
void warp_into_crown(Prototype& tree, const CrownShape& crown);

// Grows and warps: `leaf_area_m2` in about `elements` elements (never more than the grammar's organs). The
// species has a grammar. Throws Error naming what the grammar cannot do.
Prototype grown_crown(const Species& species, const CrownShape& crown, double leaf_area_m2, int elements,
                      std::uint64_t seed, const RunControl& control);

}  // namespace sunfleck
