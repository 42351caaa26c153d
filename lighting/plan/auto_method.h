// `auto`: the cheapest answer whose measured error is within a tolerance, and the error bar of any answer.
#pragma once

#include <functional>
#include <span>

#include "lighting/plan/auto_cost.h"
#include "lighting/plan/auto_options.h"
#include "lighting/plan/light_request.h"
#include "lighting/plan/light_scene.h"

namespace sunfleck {

// Runs the method that the request names. `sunlit_fraction`: of every element, where it is known already (for
// grid and links); else empty.
using MethodRunner =
    std::function<LightMap(const LightRequest&, std::span<const float> sunlit_fraction, const RunControl&)>;

// By tolerance: probes first, then one method after the other, that with the least expected cost first (see
// auto_rungs.h): `grid` as it is or with the sun drawn (lighting/trace/sun_raster.h), `links` with the sun
// drawn, at last the reference; each corrected by regression on the probes where that helps (judged on probes
// it was not fitted to). The first whose measured error is within the tolerance is the answer; if none is,
// the one with the smallest, and a note says so.
//
// By time: the same probes, then the best rung that the cost model fits into what is left. Rays are not
// started without a cheaper answer at hand and are stopped at the end of the time; a grid that takes longer
// than predicted is finished. Notes say both. Throws Error(kInvalidInput) naming "auto.time_s" before any
// work where the time is far too short.
//
// What was tried, what was measured (with 95 % intervals) and any correction stands in the provenance's
// settings. `light` as returned by checked(); `sizes` those of the forest.
LightMap auto_light_map(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
                        const LightRequest& request, const SceneSizes& sizes, const MethodRunner& run,
                        const RunControl& control);

// Measures the error of a finished map by probes and adds it to its provenance's settings:
//   measured_bias.<band>, measured_element_rms.<band>   "value [low, high]", relative, 95 % intervals
//   probes, probe_paths_per_face, probe_sun_rays, probe_seed
// A band without a standard error of its mean gets one that holds bias and uncertainty together.
void add_error_bars(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
                    const ProbePlan& plan, bool ground, LightMap& map, const RunControl& control);

}  // namespace sunfleck
