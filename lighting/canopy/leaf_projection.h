// Ecology's G-function: mean area that one m2 of leaf shows towards a direction of that zenith angle,
// averaged over azimuth. 1/2 at every angle for leaves turned any way.
#pragma once

#include <span>
#include <vector>

#include "sim/forest/forest.h"

namespace sunfleck {

// Of one leaf: |cos| of the angle between its normal (inclination from the vertical) and the direction,
// averaged over azimuth. Both in [0, pi/2]. Warren Wilson 1960, as Ross 1981 eq. II.2.
double mean_leaf_cosine(double inclination_rad, double zenith_rad);

// Of a forest's leaves, by area; shoots count with needles that point everywhere. One value per zenith angle
// (radians). 0 for a forest without leaves.
std::vector<double> leaf_projection(const Forest& forest, std::span<const double> zenith_rad);

}  // namespace sunfleck
