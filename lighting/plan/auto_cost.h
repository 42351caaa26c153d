// What steps of `auto` are expected to cost, from the sizes of the scene. The constants are seconds of one
// core of the machine they were measured on (AMD EPYC, 2026-11); machine_slowness() says how much faster or
// slower this one is, by a millisecond of similar work. Good to about a factor of 1.5.
#pragma once

#include "lighting/plan/light_request.h"

namespace sunfleck {

struct SceneSizes {
  double elements = 0, prototype_parts = 0;  // foliage and wood of all prototypes
  double wood_faces = 0;                     // of all instances
  double leaf_side_m = 0;                    // area-weighted mean root of an element's area
  double tree_extent_m = 0;                  // longest edge of a tree's box, trees by their leaf area
  double volume_m3 = 0;                      // of the box of the foliage, or of the period
  double grid_cell_m = 0;                    // grid_cell_size()
  double clumping = 1;                       // of trees' leaves, see transport/leaf_clumping.h
};
SceneSizes scene_sizes(const Forest& forest);

double cells_of_grid(const SceneSizes& sizes, double cell_m);  // 0: of the rule

// Seconds of one core of the reference machine.
double ray_scene_s(const SceneSizes& sizes);
double probes_s(const ProbePlan& plan, std::size_t bands, bool with_groups);
double grid_s(const SceneSizes& sizes, const GridOptions& options, std::size_t bands);
double sun_drawing_s(const SceneSizes& sizes, double pixel_sides);
double links_s(const SceneSizes& sizes, int links, std::size_t bands);
double reference_s(const SceneSizes& sizes, int rays, std::size_t bands, bool sun);

// Time this machine takes for what takes the reference machine one second.
double machine_slowness();

}  // namespace sunfleck
