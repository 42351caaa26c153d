// Scenes made from a seed, for benchmarks and tests: crowns of random leaves as the sheets use them.
#pragma once

#include <cstdint>
#include <string>

#include "sim/forest/forest.h"
#include "sim/plant/species.h"

namespace sunfleck {

enum class CrownKind {
  kSphere,    // leaves even in a ball
  kClumped,   // the same leaf area in 120 small clumps inside the ball
  kCone,      // upright cone, height twice its base radius
  kShell,     // between 70 and 100 % of the radius
  kEllipsoid  // upright, twice as high as wide
};

struct GeneratedCrown {
  CrownKind kind = CrownKind::kSphere;
  int leaves = 40000;
  double radius_m = 1;
  double crown_lai = 5;  // one-sided leaf area / (pi radius^2)
  std::uint64_t seed = 1;
  LeafAngles angles = LeafAngles::kSpherical;
};

// One tree of square leaves; the crown stands clear of the ground by half its radius. Its material "leaf" has
// r = t = 0.25 in VIS, 0.10 / 0.05 in PAR and 0.45 / 0.45 in NIR.
Forest generated_crown(const GeneratedCrown& crown);

// Random square leaves (spherical angles) in a box that repeats in x and y: a homogeneous canopy of that LAI.
struct GeneratedLayer {
  double lai = 2;
  double cell_m = 1, height_m = 1;
  int leaves = 10000;
  std::uint64_t seed = 1;
};
Forest generated_layer(const GeneratedLayer& layer);

}  // namespace sunfleck
