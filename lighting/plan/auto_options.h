// Knobs of `auto` and of the probes that measure the error of an answer.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace sunfleck {

// Probes: true light on a few random elements, see lighting/trace/probe_light.h.
struct ProbePlan {
  int count = 200;          // 16 .. 1000000
  int paths_per_face = 64;  // 2 .. 65536
  int sun_rays = 128;       // 2 .. 65536
  std::uint64_t seed = 1;
};

// What the tolerance is on, in the worst band. Light is front + back irradiance. Relative to its mean: over
// elements, over the whole area, over trees, over layers.
enum class AutoMeasure {
  kElementRms,       // root mean square error of the elements
  kBias,             // error of the area-weighted mean
  kTreeRms,          // RMS over trees of the error of their area-weighted mean
  kTreeAbsorbedRms,  // RMS over trees of the error of their absorbed flux (W)
  kLayerRms          // RMS over height layers of the error of their area-weighted mean
};
std::string to_string(AutoMeasure measure);  // element_rms, bias, tree_rms, tree_absorbed_rms, layer_rms
const std::vector<std::string>& auto_measure_names();
std::optional<AutoMeasure> auto_measure_from_string(const std::string& name);

// Either a tolerance, or a time within which the best answer is wanted; neither: a tolerance of 0.10. What
// fits into a time depends on the machine and its load; the choice is recorded, and the same choice gives the
// same bytes.
struct AutoOptions {
  std::optional<double> tolerance;  // more than 0, at most 1
  AutoMeasure measure = AutoMeasure::kElementRms;
  std::optional<double> time_s;  // more than 0; wall clock
  double layer_m = 1.0;          // thickness of a layer above the ground, more than 0
  int layers = 0;                // 1 .. 10000: so many layers of equal thickness instead; 0: by layer_m

  double aim() const { return tolerance.value_or(0.10); }
};

// Throw Error(kInvalidInput) naming "auto.<field>" or "probes.<field>".
void check_options(const AutoOptions& options);
void check_options(const ProbePlan& plan);

}  // namespace sunfleck
