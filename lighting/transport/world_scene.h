// The world grid: space, what its cells hold, and how much light passes them. See world_light.h.
#pragma once

#include "lighting/transport/lanes.h"
#include "lighting/transport/sweep_space.h"
#include "lighting/transport/world_kernels.h"

namespace sunfleck::transport {

// Effective area of one kind in a cell.
struct WorldEntry {
  std::uint32_t kind = 0;
  float area_m2 = 0;
};

struct WorldRange {
  std::uint32_t begin = 0, end = 0;  // cells, with about the same work each
};

struct WorldScene : SweepSpace {
  std::vector<WorldPrototype> prototypes;
  std::vector<Lanes> cover;                // per kind, mean projected area over area
  std::vector<std::uint32_t> first_entry;  // per cell, and the end
  std::vector<WorldEntry> entries;         // by cell
  std::vector<WorldRange> ranges;
  DirectionLanes lanes;
  // Directions with the same step and the same angle to the vertical pass alike.
  std::vector<std::size_t> optical_class;  // per half direction
  std::vector<float> transmittance;        // over half a step, [class][cell]
  // Where rays from cells just below the grid meet the ground: [direction][column]; empty for directions that
  // do not sink.
  std::vector<std::vector<std::int32_t>> ground_below;
  std::vector<double> instance_leaf_m2;
  double leaf_side_m = 0;

  std::span<const float> transmittance_of(std::size_t direction) const {
    return {transmittance.data() + optical_class[direction % set.half()] * cells(), cells()};
  }
  double face_m2() const { return layout.mean_cell_m() * layout.mean_cell_m(); }
};

// Cell size by the rule of WorldOptions::cell_m, without regard to memory.
double world_cell_size(const Forest& forest);
Box world_box(const Forest& forest, const GridFrame& frame);
std::uint64_t world_bytes_per_cell(int directions);

std::vector<WorldPrototype> world_prototypes(const Forest& forest, double cell_m, const RunControl& control);
WorldScene world_scene(const Forest& forest, std::vector<WorldPrototype> prototypes, const GridLayout& layout,
                       DirectionSet set, const RunControl& control);

}  // namespace sunfleck::transport
