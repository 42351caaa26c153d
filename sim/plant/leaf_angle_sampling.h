// Draws leaf normals of a leaf-angle distribution: inclination by its density, azimuth uniform.
#pragma once

#include "sim/base/random.h"
#include "sim/base/vec.h"
#include "sim/plant/species.h"

namespace sunfleck {

// Density of the leaf inclination theta (angle between normal and vertical, rad) on [0, pi/2]: spherical
// sin(theta), the others after de Wit 1965 (as in Ross 1981).
double leaf_inclination_density(LeafAngles angles, double inclination_rad);

// Unit normal of the upper side of a leaf (z >= 0).
Vec3 sample_leaf_normal(LeafAngles angles, RandomStream& random);

}  // namespace sunfleck
