// What the grid method can and cannot do for a forest, known before any work from prototypes, instances and
// bounds alone.
//
// The rule: a cell is clamp(extent / (32 c), 2 sides, 4 sides), extent that of the mean tree and not of the
// stand, c how clumped its leaves are (leaf_clumping.h), 1 to 1.4; in trees of more than 200,000 leaves as
// much larger as keeps cells fewer than leaves. Below 1.5 sides (kFewestSides) a leaf lights and shades
// itself and depths are wrong by tens of percent; above 4 sides crowns blur; prototypes of fewer than 300
// elements (kFewElements) are no random medium: rays suit all three better. The side is the area-weighted
// mean root of a leaf's area, for shoots of their mean silhouette.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lighting/transport/grid_estimator.h"

namespace sunfleck {

inline constexpr std::size_t kFewElements = 300;
inline constexpr double kFewestSides = 1.5, kMostSides = 4.0;

struct GridSuitability {
  double leaf_side_m = 0;
  double cell_m = 0;  // that would be used
  double cell_sides = 0;
  std::uint64_t cells = 0, bytes = 0;  // bytes: of cells and elements at work
  double smallest_cell_m = 0;          // that fits the memory limit, to about 1 %
  std::size_t fewest_elements = 0;     // of a prototype that has any
  bool fits = true;                    // the cells, if their size was asked for; always true if not
  bool few_elements = false;           // some prototype has fewer than kFewElements
  bool small_cells = false;            // below kFewestSides
  bool coarse_cells = false;           // above kMostSides: blurred, not wrong on average

  // False: results may be wrong by 10 % and more, or the run would be refused.
  bool suitable() const { return fits && !few_elements && !small_cells; }
};

// Edge of a cell by the rule, 0 where leaves or their trees have no size to go by. Cost: as below.
double grid_cell_size(const Forest& forest);

// Cost: one look at every element of every prototype. Throws what prepare_grid() throws for bad options.
GridSuitability grid_suitability(const Forest& forest, const GridOptions& options);

// Throws Error(kLimitExceeded) naming "grid.cell_m" where a cell size that was asked for does not fit the
// memory limit, and what check_grid_options() throws.
void check_grid_fits(const Forest& forest, const GridOptions& options);

// Throws Error(kInvalidInput) naming "grid.<field>".
void check_grid_options(const GridOptions& options);

// Memory at work: per cell the light and the transmittance of all directions, per element its place, optics,
// light of the orders and one band of the answer.
std::uint64_t grid_bytes(std::uint64_t cells, std::uint64_t elements, int directions);

}  // namespace sunfleck
