#include "lighting/plan/auto_options.h"

#include "sim/base/error.h"

namespace sunfleck {

std::string to_string(AutoMeasure measure) {
  return measure == AutoMeasure::kElementRms ? "element_rms" : "bias";
}

void check_options(const AutoOptions& options) {
  if (!(options.tolerance > 0.0 && options.tolerance <= 1.0))
    throw_invalid("auto.tolerance", std::to_string(options.tolerance) + " is out of range",
                  "a share of the mean irradiance, more than 0, at most 1");
}

void check_options(const ProbePlan& plan) {
  const auto check = [](int value, int lowest, int highest, const char* key) {
    if (value < lowest || value > highest)
      throw_invalid(std::string("probes.") + key, std::to_string(value) + " is out of range",
                    std::to_string(lowest) + " to " + std::to_string(highest));
  };
  check(plan.count, 16, 1000000, "count");
  check(plan.paths_per_face, 2, 65536, "paths_per_face");
  check(plan.sun_rays, 2, 65536, "sun_rays");
}

}  // namespace sunfleck
