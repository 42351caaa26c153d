// From a solved band to its answer: light of every element and where the energy went.
#pragma once

#include "lighting/base/light_map.h"
#include "lighting/links/direct_light.h"
#include "lighting/links/outer_light.h"

namespace sunfleck::links {

struct LinkSources {
  double beam_w_m2 = 0, diffuse_w_m2 = 0;
  double ground_beyond_w_m2 = 0;  // radiosity of the ground beyond the cells
  double open_w_m2 = 0;           // on one m2 of the ground plane, both sides, nothing in the way
};

// Irradiance of a face before any scattering.
double first_light_w_m2(const LinkSources& sources, const DirectLight& direct, const OuterLight& outer,
                        std::size_t face);

// Fills elements and budget; what summarize() fills is left to it. The residual is what the noise of the
// links leaves open: light given and received balance on average only.
void fill_band(const LinkProblem& problem, const LinkSolution& solution, const LinkSources& sources,
               const DirectLight& direct, const OuterLight& outer, BandLightMap& map,
               const RunControl& control);

}  // namespace sunfleck::links
