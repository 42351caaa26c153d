// What steps of `auto` are expected to cost, from the sizes of the scene. The constants are seconds of one
// core of the machine they were measured on (AMD EPYC, 2026-11); machine_speed() says how much faster or
// slower this one is, by a millisecond of similar work. Good to about a factor of 1.5.
#pragma once

#include <string>
#include <vector>

#include "lighting/plan/light_request.h"

namespace sunfleck {

struct SceneSizes {
  double elements = 0, prototype_parts = 0;  // foliage and wood of all prototypes
  double wood_faces = 0;                     // of all instances
  double leaf_side_m = 0;                    // area-weighted mean root of an element's area
  double volume_m3 = 0;                      // of the box of the foliage, or of the period
  double extent_m = 0;                       // its longest edge
};
SceneSizes scene_sizes(const Forest& forest);

double cells_of_grid(const SceneSizes& sizes, double cell_m);  // 0: the rule of leaf_cell_size()
std::uint64_t grid_bytes(double cells, int directions);

// Seconds of one core of the reference machine.
double ray_scene_s(const SceneSizes& sizes);
double probes_s(const ProbePlan& plan, std::size_t bands, bool with_groups);
double grid_s(const SceneSizes& sizes, const GridOptions& options, std::size_t bands);
double sun_drawing_s(const SceneSizes& sizes, double target_error);
double reference_s(const SceneSizes& sizes, int rays, std::size_t bands, bool sun);

// Time this machine takes for what takes the reference machine one second.
double machine_slowness();

// Of `grid`, coarse to fine; the request's own grid alone where its knobs were set. For `tolerance` (0: by
// time) those are left out that seldom reach it and cost much where they do not.
std::vector<GridOptions> grid_rungs(const SceneSizes& sizes, const GridOptions& asked, double tolerance);

}  // namespace sunfleck
