// world: light in a forest of thousands of instances without ever touching its leaves one by one; and the
// leaves of any one tree on request.
//
// World grid. Cells of about half a metre over the whole forest. What a cell holds is the sum over instances
// of the leaf statistics of their prototypes: effective leaf and wood area of half-cells of the prototype's
// own crown, with the shade that leaves cast on each other inside a cell already taken off (measured on cells
// of 2.5 leaf sides). Leaf angles enter as one scattering kernel per prototype and band between the
// directions of the set, the mean over its leaves turned about the vertical through 16 azimuths: instances
// may stand in any yaw, but a crown whose leaves face outwards scatters as if they faced every way. Sun, sky
// and all bounces are swept through that grid.
//
// One tree. tree_light() puts the tree's own leaves into a fine grid of its own (2 to 4 leaf sides, the yaw
// and every leaf angle exact) that reaches a world cell beyond it on all sides. Light enters at its border
// as the world grid has it there: a ray that is about to enter has not yet met the tree, so its own shade is
// not in that light but by way of others that it lights or shades, where it belongs. Inside the border, other
// trees are what the world grid's cells hold less the tree's own part of them, computed by the same sums:
// nothing of the tree counts twice, interlocking crowns included.
//
// Where this stops being true: neighbours shade as cells, not as leaves (traced sun mends that for direct
// light); prototypes of a few hundred leaves are no random medium.
#pragma once

#include <memory>

#include "lighting/base/light_map.h"
#include "lighting/optics/optics.h"
#include "lighting/sky/illumination.h"
#include "sim/base/run_control.h"
#include "sim/forest/forest.h"

namespace sunfleck {

struct WorldOptions {
  // ---- part of the preparation
  int directions = 26;  // 8, 14 or 26; in a periodic scene as for the grid method
  // Edge of a world cell; 0: a sixth of the mean crown width, at least 2 leaf sides, at most 0.5 m; coarser,
  // with a note, where the cells would not fit the memory limit. A size given here is kept or refused.
  double cell_m = 0;
  std::uint64_t memory_limit_bytes = 1ull << 30;  // of the cells, with two bands of light
  // ---- part of each answer
  double convergence = 2e-3;  // of scattered power, relative, in the world and in each tree
  int max_iterations = 60;
};

namespace transport {
struct WorldScene;
struct WorldSources;
struct WorldKernels;
}  // namespace transport

// What does not depend on sun, sky and bands. Cheap to copy.
struct WorldPrepared {
  std::shared_ptr<const transport::WorldScene> scene;
  std::vector<std::string> notes;
  std::vector<StageTime> times;  // "prototypes", "world grid"
};

struct WorldBand {
  std::string band;
  std::vector<float> radiance;           // of sky and scattered light, W m-2 sr-1, [direction][cell]
  std::vector<float> ground_irradiance;  // of all light, per ground cell, W m-2
  std::vector<TreeLight> trees;          // in instance order; sunlit area 0 with no sun
  EnergyBudget budget;
  bool has_budget = false;  // periodic scenes
  double mean_irradiance_w_m2 = 0;
  int iterations = 0;
  bool converged = true;
  std::shared_ptr<const transport::WorldKernels> kernels;
};

struct WorldLight {
  WorldPrepared prepared;
  Illumination light;
  std::shared_ptr<const transport::WorldSources> sources;  // sun transmittance and sky of every cell
  std::vector<WorldBand> bands;
  std::vector<StageTime> times;
};

// Throws Error(kInvalidInput) naming "world.<field>" or "forest"; Error(kLimitExceeded) for a cell size that
// does not fit the memory limit, before any work; Error(kCancelled).
WorldPrepared prepare_world(const Forest& forest, const WorldOptions& options, const RunControl& control);

WorldLight world_light(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                       const WorldOptions& options, const WorldPrepared& prepared, const RunControl& control);

// The leaves of one instance, elements in prototype order, one tree in every band. `world` must be of this
// forest and these optics.
LightMap tree_light(const Forest& forest, const OpticsTable& optics, const WorldLight& world,
                    std::size_t instance, const WorldOptions& options, const RunControl& control);

}  // namespace sunfleck
