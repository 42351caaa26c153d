// A sky seen through a set of directions: its radiance averaged over the part of the sphere that is nearest
// to each of them, and the share of that part that the ground fills. By a lattice of 8192 directions that a
// quarter turn and the horizon map onto itself; a lattice direction between two of the set counts for both.
#pragma once

#include <span>
#include <vector>

#include "lighting/sky/sky_radiance.h"
#include "sim/base/vec.h"

namespace sunfleck {

// For a diffuse irradiance of 1 on a horizontal plane.
struct SkyByDirection {
  std::vector<double> radiance;       // 1/sr, one per direction, counting 0 where its part is ground
  std::vector<double> ground_share;   // of its part, [0, 1]
  double open_ground_irradiance = 0;  // of the open ground by the same sky
};

// Directions and `ground_normal` (upwards) are unit vectors; there is at least one lattice direction nearest
// to each.
SkyByDirection sky_by_direction(std::span<const Vec3> to_source, const SkyRadiance& sky,
                                const Vec3& ground_normal);

}  // namespace sunfleck
