// The stem of a crown prototype: a cone from the ground to the top that has the DBH at 1.3 m.
#pragma once

#include <vector>

#include "sim/plant/make_prototype.h"

namespace sunfleck {

// Below 1.3 m the cone goes on, but not beyond 1.25 times the radius at 1.3 m (a tree hardly taller than 1.3
// m would get a foot as wide as itself). A tree below 1.3 m gets a cone of the DBH at the ground.
std::vector<WoodSegment> crown_stem(const CrownShape& crown);

// Radius of that stem at a height; 0 above the top.
double stem_radius_m(const CrownShape& crown, double height_m);

}  // namespace sunfleck
