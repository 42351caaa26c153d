// Stand light for large stands (tens of thousands of trees): unscattered light on the ground and on every
// tree over any intervals, by sweeps through boxes of leaf area, one per direction.
//
// prepare_large_stand() depends on the forest only; large_stand_light() on the directions and weights. Light
// that leaves, wood and ground throw back is not followed: multiply intercepted light by what leaves absorb
// (1 - albedo) for a first estimate of absorbed PAR, a few percent low. A forest that does not repeat stands
// in the open; its map is its bounds.
#pragma once

#include <string>
#include <vector>

#include "lighting/canopy/box_canopy.h"
#include "lighting/canopy/crown_optics.h"
#include "lighting/canopy/light_weights.h"
#include "lighting/canopy/response_table.h"
#include "lighting/canopy/stand_scene.h"

namespace sunfleck {

struct LargeStandOptions {
  double voxel_m = 1;          // edge of a box, 0.1 to 20 m
  int boxes_per_cell = 2;      // ground cells are this many boxes wide, 1 .. 100: 2 m cells by default
  int crown_rays = 1000;       // per prototype, zenith and azimuth, 16 .. 1e6
  int directions_at_once = 4;  // each takes 4 bytes per box; 1 .. 64; changes no result
  std::uint64_t seed = 1;
};

struct LargeStandPrepared {
  LargeStandOptions options;
  BoxCanopy canopy;
  std::vector<CrownOptics> crowns;  // per prototype
  StandGround map;
};
LargeStandPrepared prepare_large_stand(const Forest& forest, const LargeStandOptions& options,
                                       const RunControl& control);

// Tables without standard errors (0): sweeps have no noise but that of the crowns' rays. How far they are off
// is measured by large_stand_check.h.
struct LargeStandLight {
  std::vector<std::string> intervals;
  StandGround map;
  IntervalTable ground_direct_share, ground_diffuse_share;  // [interval][ground cell], of open light
  IntervalTable ground_total;                               // energy per m2 of map
  IntervalTable tree_intercepted, tree_potential;           // energy, [interval][instance]
  IntervalTable light_competition;                          // intercepted / potential
  // Energy on the map and what became of it. Periodic forests: incident = trees + ground. Open ones: trees
  // also take light that aims beyond the map.
  std::vector<double> incident, trees, ground;
};
LargeStandLight large_stand_light(const Forest& forest, const LargeStandPrepared& prepared,
                                  const StandSky& sky, const RunControl& control);

}  // namespace sunfleck
