// From a solved band to its answer: light of every element with its standard error, trees, energy budget.
#pragma once

#include "lighting/base/light_map.h"
#include "lighting/trace/radiosity.h"

namespace sunfleck::trace {

struct SolvedBand {
  BandProblem problem;
  Radiosity<1> radiosity;
  Radiosity<kGroups> without_groups;
};

// Where the standard error of the elements comes from: mean squares over the elements.
struct ErrorShares {
  double by_rays = 0, by_sun_rays = 0;
  double mean_irradiance_w_m2 = 0;
  double relative() const {
    const double squares = by_rays + by_sun_rays;
    return squares > 0.0 ? std::sqrt(squares) / mean_irradiance_w_m2 : 0.0;
  }
};

// Fills elements, standard errors, tree standard errors, budget and the mean's error; what
// summarize() fills is left to it. `open` is what falls on one m2 of the ground plane, both sides, with
// nothing in the way.
ErrorShares fill_band(const SolvedBand& solved, double open_irradiance_w_m2, const Illumination& light,
                      BandLightMap& map, const RunControl& control);

}  // namespace sunfleck::trace
