// Error and run time of methods on one scene, measured together: the truth is the reference with many rays,
// and its own noise is stated beside every figure.
#pragma once

#include <string>
#include <vector>

#include "lighting/plan/light_request.h"

namespace sunfleck {

// All relative to the mean of the truth; quantity: front + back irradiance of an element.
struct ErrorFigures {
  double bias = 0;         // (mean - true mean) / true mean
  double element_rms = 0;  // per element, the truth's noise taken out
  double cell_rms = 0;     // after averaging in 4^3 cells of the scene's box ([SPP] Eq. 30 averages alike)
  double scattered_rms =
      0;  // per element, of sky + scattered light only, relative to their own mean; with the noise
};

struct BenchmarkRow {
  std::string scene, band, method, knob;
  std::size_t elements = 0;
  ErrorFigures error;
  double truth_noise = 0;  // RMS standard error of the truth per element, relative to its mean
  double wall_s = 0, cpu_s = 0;
  double setup_s = 0;  // part of wall_s spent on what a change of sun or band would reuse
};

struct BenchmarkPlan {
  int truth_rays = 256;
  int repeats = 3;  // medians over these
  CostOptions cost{1};
  std::vector<Method> methods;  // besides the reference at a few ray counts, which always runs
};

// `request` states sun, sky and bands (one row per band and method).
std::vector<BenchmarkRow> error_against_time(const Forest& forest, const LightRequest& request,
                                             const BenchmarkPlan& plan, const RunControl& control);

ErrorFigures compare(const Forest& forest, const BandLightMap& estimate, const BandLightMap& truth);

}  // namespace sunfleck
