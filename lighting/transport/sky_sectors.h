// What comes from outside along each direction: the sky's radiance averaged over the sector that is nearest
// to the direction, and the part of the sector that ground fills.
#pragma once

#include <vector>

#include "lighting/sky/illumination.h"
#include "lighting/transport/direction_set.h"

namespace sunfleck::transport {

struct SkySectors {
  // For a diffuse irradiance of 1 on a horizontal plane, 1/sr; 0 for the part of a sector that is ground.
  std::vector<double> sky_radiance;
  std::vector<double> ground_share;  // [0, 1]
  // Irradiance of the open ground by the same sky.
  double open_ground_irradiance = 1;
  // Per direction above the ground: irradiance of the ground for radiance 1 from there, sr; else 0. Scaled so
  // that the open sky brings open_ground_irradiance.
  std::vector<double> ground_weight_sr;
};

// `ground_normal` is unit, upwards.
SkySectors sky_sectors(const DirectionSet& set, const SkyRadiance& sky, const Vec3& ground_normal);

}  // namespace sunfleck::transport
