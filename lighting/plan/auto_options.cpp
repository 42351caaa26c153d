#include "lighting/plan/auto_options.h"

#include <array>
#include <cmath>
#include <sstream>
#include <utility>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

constexpr std::array<std::pair<AutoMeasure, const char*>, 5> kMeasures = {
    {{AutoMeasure::kElementRms, "element_rms"},
     {AutoMeasure::kBias, "bias"},
     {AutoMeasure::kTreeRms, "tree_rms"},
     {AutoMeasure::kTreeAbsorbedRms, "tree_absorbed_rms"},
     {AutoMeasure::kLayerRms, "layer_rms"}}};

[[noreturn]] void refuse(const std::string& field, double value, const std::string& remedy) {
  std::ostringstream text;
  text << value;
  throw_invalid(field, text.str() + " is out of range", remedy);
}

}  // namespace

std::string to_string(AutoMeasure measure) {
  for (const auto& [value, name] : kMeasures)
    if (value == measure) return name;
  return {};
}

const std::vector<std::string>& auto_measure_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const auto& entry : kMeasures) list.emplace_back(entry.second);
    return list;
  }();
  return names;
}

std::optional<AutoMeasure> auto_measure_from_string(const std::string& name) {
  for (const auto& [value, text] : kMeasures)
    if (name == text) return value;
  return {};
}

void check_options(const AutoOptions& o) {
  if (o.tolerance && o.time_s)
    throw_invalid("auto.time_s", "a tolerance is given as well",
                  "one of them: what the answer must be worth, or how long it may take");
  if (o.tolerance && !(*o.tolerance > 0.0 && *o.tolerance <= 1.0))
    refuse("auto.tolerance", *o.tolerance, "a share of the mean irradiance, more than 0, at most 1");
  if (o.time_s && !(*o.time_s > 0.0 && std::isfinite(*o.time_s)))
    refuse("auto.time_s", *o.time_s, "seconds, more than 0");
  if (!(o.layer_m > 0.0 && std::isfinite(o.layer_m)))
    refuse("auto.layer_m", o.layer_m, "a thickness in metres, more than 0");
  if (o.layers < 0 || o.layers > 10000)
    refuse("auto.layers", o.layers, "1 to 10000, or 0 for layers of layer_m");
}

void check_options(const ProbePlan& plan) {
  const auto check = [](int value, int lowest, int highest, const char* key) {
    if (value < lowest || value > highest)
      refuse(std::string("probes.") + key, value, std::to_string(lowest) + " to " + std::to_string(highest));
  };
  check(plan.count, 16, 1000000, "count");
  check(plan.paths_per_face, 2, 65536, "paths_per_face");
  check(plan.sun_rays, 2, 65536, "sun_rays");
}

}  // namespace sunfleck
