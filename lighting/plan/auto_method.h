// `auto`: the cheapest answer whose measured error is within a tolerance, and the error bar of any answer.
#pragma once

#include <functional>

#include "lighting/plan/auto_options.h"
#include "lighting/plan/light_request.h"
#include "lighting/plan/light_scene.h"

namespace sunfleck {

// Runs the method that the request names.
using MethodRunner = std::function<LightMap(const LightRequest&)>;

// Probes first, then one method after the other, cheapest first: as it is or corrected by regression on the
// probes (judged on probes it was not fitted to), then with direct sun by shadow rays where the probes say
// that this will do, at last the reference. The first whose measured error is within the tolerance is the
// answer; if none is, the one with the smallest, and a note says so. What was tried, what was measured
// (with 95 % intervals) and any correction stands in the provenance's settings.
// `light` as returned by checked().
LightMap auto_light_map(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
                        const LightRequest& request, const MethodRunner& run, const RunControl& control);

// Measures the error of a finished map by probes and adds it to its provenance's settings:
//   measured_bias.<band>, measured_element_rms.<band>   "value [low, high]", relative, 95 % intervals
//   probes, probe_paths_per_face, probe_sun_rays, probe_seed
// A band without a standard error of its mean gets one that holds bias and uncertainty together.
void add_error_bars(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
                    const ProbePlan& plan, bool ground, LightMap& map, const RunControl& control);

}  // namespace sunfleck
