// grid: discrete ordinates on the leaf-area grid, all bounces of sun and sky. Radiance is swept through the
// grid along 8, 14 or 26 directions; every leaf scatters with its own angle and optics into its cell; wood is
// opaque; the ground is a Lambertian plane. Direct sun: one march of the grid per leaf, or given.
//
// Good for crowns and stands that are random media at the scale of a cell (2 to 4 leaf sides): leaf-exact sun
// patterns need rays (which may have drawn them before, see grid_sources()), plants of a few hundred leaves
// too (grid_limits.h says so before any work, a note afterwards). In a periodic scene directions that never
// reach the ground or the sky are replaced by others close to level (16 instead of 14 directions).
//
// Three steps, each kept by whoever asks again: prepare_grid() for the forest, grid_sources() for a sun
// direction and a sky model, grid_light_map() for strengths and bands.
#pragma once

#include <memory>
#include <span>

#include "lighting/base/light_map.h"
#include "lighting/optics/optics.h"
#include "lighting/sky/illumination.h"
#include "sim/base/run_control.h"
#include "sim/forest/forest.h"

namespace sunfleck {

struct GridOptions {
  // ---- part of the preparation
  int directions = 26;  // 8, 14 or 26
  // Edge of a cell; 0: clamp(extent / 32, 2 side, 4 side) with the extent of the mean tree and the mean side
  // of a leaf, finer in clumped crowns (grid_limits.h), coarser, with a note, where the cells would not fit
  // into the memory limit. A size given here is kept or refused.
  double cell_m = 0;
  std::uint64_t memory_limit_bytes = 3ull << 29;  // of cells and elements together, see grid_limits.h
  // ---- part of each answer
  // Bounces end when the power scattered by all of them is known to about this, relative. What is missing
  // then is added in the shape of the last bounce.
  double convergence = 2e-3;
  int max_iterations = 60;
};

namespace transport {
struct TransportScene;
struct GridSky;
struct GridSun;
}  // namespace transport

// What does not depend on sun, sky and bands. Cheap to copy; any number of threads may read it.
struct GridPrepared {
  std::shared_ptr<const transport::TransportScene> scene;
  std::string forest_hash;
  std::vector<std::string> notes;  // limits of the method that the forest touches
  std::vector<StageTime> times;
};

// What depends on the sun's direction (`sun`) or the shape of the sky (`sky`), not on their strengths.
struct GridSources {
  std::shared_ptr<const transport::GridSun> sun;  // null: no direct light
  std::shared_ptr<const transport::GridSky> sky;
};

// Throws Error(kInvalidInput) naming "grid.<field>" or "forest"; Error(kLimitExceeded) where a cell size that
// was asked for does not fit the memory limit, before any other work; Error(kCancelled).
GridPrepared prepare_grid(const Forest& forest, const GridOptions& options, const RunControl& control);

// Takes over what still holds of `before` (sources of the same `prepared`).
GridSources grid_sources(const Forest& forest, const Illumination& light, const GridPrepared& prepared,
                         const GridSources& before, const RunControl& control);

// The same with the direct sun of the elements already known: the share of each that the sun reaches, [0, 1],
// in ForestIndex order, from a picture of the sun or shadow rays (lighting/trace/direct_exposure.h). It
// becomes the direct part of the answer and the source of scattered light, in place of one march per element;
// ground and wood are still marched. What still holds of `before` is its sky. Throws Error(kInvalidInput)
// naming "sunlit_fraction".
GridSources grid_sources(const Forest& forest, const Illumination& light, const GridPrepared& prepared,
                         std::span<const float> sunlit_fraction, const GridSources& before,
                         const RunControl& control);

// `prepared` and `sources` must be those of this forest and this light's directions. Throws
// Error(kInvalidInput) naming "grid.<field>" or "illumination.<field>"; Error(kCancelled). Sky and scattered
// light of sources solved together: sums of separate answers agree within `convergence`.
LightMap grid_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                        const GridOptions& options, const GridPrepared& prepared, const GridSources& sources,
                        const RunControl& control);

// The same with the sources made anew; and all three steps in one, whose provenance has all their times.
LightMap grid_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                        const GridOptions& options, const GridPrepared& prepared, const RunControl& control);
LightMap grid_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                        const GridOptions& options, const RunControl& control);

}  // namespace sunfleck
