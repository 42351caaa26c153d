// Knobs of `auto` and of the probes that measure the error of an answer.
#pragma once

#include <cstdint>
#include <string>

namespace sunfleck {

// Probes: true light on a few random elements, see lighting/trace/probe_light.h.
struct ProbePlan {
  int count = 200;          // 16 .. 1000000
  int paths_per_face = 64;  // 2 .. 65536
  int sun_rays = 128;       // 2 .. 65536
  std::uint64_t seed = 1;
};

// What the tolerance is on; both relative to the mean irradiance, in the worst band.
enum class AutoMeasure {
  kElementRms,  // root mean square error of the elements' front + back irradiance
  kBias         // error of the area-weighted mean
};
std::string to_string(AutoMeasure measure);  // element_rms, bias

struct AutoOptions {
  double tolerance = 0.10;  // more than 0, at most 1
  AutoMeasure measure = AutoMeasure::kElementRms;
};

// Throw Error(kInvalidInput) naming "auto.<field>" or "probes.<field>".
void check_options(const AutoOptions& options);
void check_options(const ProbePlan& plan);

}  // namespace sunfleck
