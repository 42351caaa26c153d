// The settings each method is measured with, from cheap to dear.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lighting/plan/light_request.h"

namespace sunfleck {

struct MethodStep {
  Method method = Method::kGrid;
  std::string knob;  // "default", or what is set: "8 directions"
  std::function<void(LightRequest&)> set;
};

std::vector<MethodStep> method_ladder(Method method);

// Names of methods separated by commas, or "all". Throws Error(kInvalidInput) listing the names.
std::vector<MethodStep> method_ladders(const std::string& names);

}  // namespace sunfleck
