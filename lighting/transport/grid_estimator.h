// grid: discrete ordinates on the leaf-area grid, all bounces of sun and sky. Radiance is swept through the
// grid along 8, 14 or 26 directions; every leaf scatters with its own angle and optics into its cell; wood is
// opaque; the ground is a Lambertian plane. Direct sun: one march of the grid per leaf.
//
// Good for crowns and stands that are random media at the scale of a cell (2 to 4 leaf sides): leaf-exact sun
// patterns need rays, plants of a few hundred leaves too (a note says so). In a periodic scene directions
// that never reach the ground or the sky are replaced by others close to level (16 instead of 14 directions).
#pragma once

#include "lighting/base/light_map.h"
#include "lighting/optics/optics.h"
#include "lighting/sky/illumination.h"
#include "sim/base/run_control.h"
#include "sim/forest/forest.h"

namespace sunfleck {

struct GridOptions {
  int directions = 26;  // 8, 14 or 26
  // Edge of a cell; 0: clamp(extent / 32, 2 side, 4 side) with the mean side of a leaf. Coarser, with a note,
  // where the cells would not fit into about 1.5 GiB.
  double cell_m = 0;
  // Bounces end when the power scattered by all of them is known to about this, relative. What is missing
  // then is added in the shape of the last bounce.
  double convergence = 2e-3;
  int max_iterations = 60;
};

// Throws Error(kInvalidInput) naming "grid.<field>", "forest" or "illumination.<field>"; Error(kCancelled).
// Sky and scattered light of sources solved together: sums of separate answers agree within `convergence`.
LightMap grid_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                        const GridOptions& options, const RunControl& control);

}  // namespace sunfleck
