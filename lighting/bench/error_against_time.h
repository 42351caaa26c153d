// Error and run time of methods on one scene, measured together: the truth is the reference with many rays,
// and its own noise is stated beside every figure.
#pragma once

#include <string>
#include <vector>

#include "lighting/bench/error_figures.h"
#include "lighting/bench/method_ladder.h"
#include "lighting/plan/light_request.h"

namespace sunfleck {

struct BenchmarkRow {
  std::string scene, band, method, knob;
  std::size_t elements = 0, instances = 0;
  ErrorFigures error;
  double truth_noise = 0;  // RMS standard error of the truth per element, relative to its mean
  double wall_s = 0, cpu_s = 0;
  double setup_s = 0;  // part of wall_s that a change of sun, sky or band does not repeat
  std::uint64_t rays = 0;
  std::uint64_t peak_memory_bytes = 0;  // of the process while it ran
  std::uint64_t seed = 0;
};

struct BenchmarkPlan {
  int truth_rays = 256;
  int repeats = 3;  // medians over these
  CostOptions cost{1};
  std::vector<MethodStep> steps;
};

// `request` states sun, sky and bands (one row per band and step). Checks before it times: an answer that
// violates an invariant, differs between two runs, or claims a standard error that its mean misses fivefold
// throws ContractViolation. A step whose method refuses the scene gives no row and one line in `refused`.
std::vector<BenchmarkRow> error_against_time(const Forest& forest, const LightRequest& request,
                                             const BenchmarkPlan& plan, std::vector<std::string>& refused,
                                             const RunControl& control);

// Sun at 35 degrees zenith and 160 azimuth (400 W m-2 on the horizontal) and a uniform sky (100), for bands
// by name: VIS (r = t = .25), PAR (.10 / .05), NIR (.45 / .45), WHITE (.50 / .50), or "all". Crowns made by
// bench_scenes() take these optics; L-system trees and stands their species' (PAR and NIR only).
LightRequest bench_light(const Forest& forest, const std::string& bands);

}  // namespace sunfleck
