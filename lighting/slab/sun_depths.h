// Optical depth of every element towards the sun and away from it, from the sun's own maps at full resolution
// ([SPP] Fig. 9, step 5), and the compensation factor of every cell for sunlight.
#pragma once

#include <vector>

#include "lighting/slab/cell_depths.h"
#include "lighting/slab/forest_grids.h"
#include "lighting/slab/sky_light.h"
#include "sim/base/run_control.h"

namespace sunfleck {

struct SunDepths {
  std::vector<float> before, behind;  // per element
  std::vector<float> turn_ratio;      // per instance, see CellDepths::turn_ratio
  int map_resolution = 0;             // texels along the longer side, after the memory limit
  double texel_m = 0;                 // of the coarsest map
  std::size_t maps = 0;
  double yaw_step_rad = 0;  // instances were turned to multiples of it to share maps; 0: their own yaw
  bool complete = true;     // false: a periodic forest repeats farther than was followed
};

// Maps share 1 GiB: their resolution is halved until they fit. From 256 different (prototype, yaw) on, yaws
// are rounded to 1/64 turn.
SunDepths measure_sun_depths(const Forest& forest, const ForestIndex& index, const Vec3& to_sun,
                             int map_resolution, const RunControl& control);

// Means over the elements of every cell.
struct CellSun {
  std::vector<float> before, behind;
  std::vector<float> turn_ratio;  // per instance
};
CellSun mean_over_cells(const Forest& forest, const ForestIndex& index, const ForestGrids& grids,
                        const SunDepths& sun, const RunControl& control);

// The same measured for the cells alone, neighbours at their centres: what a change of sun costs where light
// is wanted by cell and not by leaf ([SPP] step 5).
CellSun measure_cell_sun(const Forest& forest, const ForestGrids& grids, const Vec3& to_sun,
                         int map_resolution, const RunControl& control);
// Scattered sunlight of every cell per normal irradiance of the sun; `compensation` per cell, or empty.
ScatteredCells scattered_sunlight(const Forest& forest, const ForestGrids& grids, const CellSun& sun,
                                  const ResponseMedium& medium, const Vec3& to_sun,
                                  std::span<const float> compensation, const RunControl& control);

// G of every cell for light from a direction: [SPP] Eq. 27 with the depths of the cell's elements averaged.
std::vector<float> sun_compensation(const CellDepths& cells, const CellSun& sun, const Vec3& to_sun,
                                    const RunControl& control);

}  // namespace sunfleck
