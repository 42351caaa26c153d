// Geographic places as metres in a plane.
#pragma once

#include <string>
#include <vector>

#include "sim/forest/forest_spec.h"

namespace sunfleck {

// x_m, y_m hold longitude and latitude (degrees, WGS84) on entry, metres east and north of their mean on
// return: local radii of curvature of the ellipsoid at the mean latitude, good to 1e-4 of the distance within
// 10 km. Returns a sentence that states the origin.
std::string to_plane_coordinates(std::vector<InventoryTree>& trees);

}  // namespace sunfleck
