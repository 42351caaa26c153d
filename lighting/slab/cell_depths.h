// Preprocessing of [SPP] (Fig. 9, steps 2 and 3): optical depth from every cell of every instance in all
// sample directions, and what the sky's light keeps on its way to the cell.
#pragma once

#include <span>
#include <vector>

#include "lighting/slab/forest_grids.h"
#include "lighting/slab/sample_directions.h"
#include "sim/base/run_control.h"

namespace sunfleck {

struct CellDepths {
  SampleDirections directions;
  std::size_t cells = 0;
  std::vector<float> depth;         // [direction][cell], to the boundary of the trees or the ground
  std::vector<float> transmission;  // [axis][cell], of light from above: mean of e^-depth over the elements
  // [prototype][key of direction]: <(n.s)^2> / <|n.s|> over the leaves, 2/3 for random ones
  std::vector<float> turn_ratio;
  bool complete = true;  // false: a periodic forest repeats farther than was followed

  // Of all cells in one direction; directions [0, axes) look up, axis + axes is the opposite of axis.
  std::span<const float> depths(std::size_t direction) const {
    return {depth.data() + direction * cells, cells};
  }
  std::span<const float> transmissions(std::size_t axis) const {
    return {transmission.data() + axis * cells, cells};
  }
  float turn_ratio_of(std::uint32_t prototype, std::size_t axis, double yaw_rad) const {
    return turn_ratio[prototype * directions.keys() + directions.key(axis, directions.step_of(yaw_rad))];
  }
};

// A cell's depth is the mean over its elements, their own leaves left out, in the maps of its own tree, plus
// the neighbours' at the cell's centre. 4 bytes for each of 3/2 directions and cell.
CellDepths measure_cell_depths(const Forest& forest, const ForestGrids& grids, int sample_directions,
                               int map_resolution, const RunControl& control);

}  // namespace sunfleck
