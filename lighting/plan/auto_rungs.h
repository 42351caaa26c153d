// What `auto` can try, each with a prediction of its error and its cost. The predictions only decide what is
// tried first; what an answer is worth is measured.
//
// Error of the diffuse light of `grid` with the sun drawn and a correction: a part k of the spread that
// diffuse light has over the elements, k by the width of a cell against a tree and by the directions, smaller
// where leaves are spread evenly; measured on crowns and L-system trees of 4,000 to 100,000 elements, PAR
// and NIR (tests/bench/plan/rungs_bench.cpp), good to about a tenth, a quarter where shoots are large. Error
// of direct light drawn: see sun_pixel_sides(). Of `links`: by the number of links. All in shares of the mean
// light.
#pragma once

#include <string>
#include <vector>

#include "lighting/plan/auto_cost.h"
#include "lighting/plan/auto_probe.h"

namespace sunfleck {

// What the probes say of the light, in the band where each is largest.
struct LightSpread {
  double direct_share = 0;  // of the mean light
  double diffuse_share = 0;
  double diffuse_spread = 0;  // standard deviation of diffuse light over the elements / mean light
  double sun_scatter = 0;     // sqrt(mean p (1 - p)) / mean p of the sunlit fractions p
  double sun_spread = 0;      // standard deviation of p / mean p
};
LightSpread light_spread(const ProbeSet& probes, std::size_t bands);

enum class RungKind { kGrid, kDrawnGrid, kLinks, kReference };  // kDrawnGrid: with the sun drawn
struct Rung {
  RungKind kind = RungKind::kGrid;
  GridOptions grid;
  int rays = 0;          // links or rays per face
  double sun_error = 0;  // of drawn direct light, relative to its mean
  double predicted_error = 0, predicted_s = 0;
  std::string name() const;
};

// Side of a pixel, in leaf sides, for a relative error of drawn direct light.
double sun_pixel_sides(const LightSpread& spread, double error);

// For an aim of `aim` (share of the mean light) on single elements: by kinds, coarse to fine. The request's
// own grid alone where its knobs were set.
std::vector<Rung> rungs_for_elements(const SceneSizes& sizes, const LightSpread& spread,
                                     const LightRequest& request, double aim, bool sun);
// For sums (bias, trees, layers), where errors of single elements average out: few rungs, cheapest first,
// without a prediction of their error.
std::vector<Rung> rungs_for_sums(const SceneSizes& sizes, const LightSpread& spread,
                                 const LightRequest& request, double aim, bool sun);

// The one with the least cost to be expected: its own and, where it is likely to miss the aim, another's.
// `worse`: how much larger errors of grids turned out than predicted. -1: none is worth trying.
int best_rung(const std::vector<Rung>& rungs, double aim, double worse);

}  // namespace sunfleck
