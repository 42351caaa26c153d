#include "lighting/bench/method_ladder.h"

#include <sstream>

namespace sunfleck {
namespace {

MethodStep step(Method method, std::string knob, std::function<void(LightRequest&)> set = {}) {
  return {method, std::move(knob), [method, set](LightRequest& request) {
            request.method = method;
            if (set) set(request);
          }};
}

std::vector<MethodStep> reference_steps() {
  std::vector<MethodStep> steps;
  for (const int rays : {4, 16, 64})
    steps.push_back(step(Method::kReference, std::to_string(rays) + " rays", [rays](LightRequest& r) {
      r.reference.rays_per_face = r.reference.sun_rays_per_element = rays;
    }));
  return steps;
}

std::vector<MethodStep> grid_steps() {
  std::vector<MethodStep> steps;
  for (const int directions : {8, 14, 26})
    steps.push_back(step(Method::kGrid, std::to_string(directions) + " directions",
                         [directions](LightRequest& r) { r.grid.directions = directions; }));
  return steps;
}

std::vector<MethodStep> links_steps() {
  std::vector<MethodStep> steps;
  for (const int links : {16, 32, 64})
    steps.push_back(step(Method::kLinks, std::to_string(links) + " links",
                         [links](LightRequest& r) { r.links.links_per_face = links; }));
  return steps;
}

std::vector<MethodStep> envelope_steps() {
  std::vector<MethodStep> steps;
  for (const int directions : {8, 14, 26})
    steps.push_back(step(Method::kEnvelopeFull, std::to_string(directions) + " directions",
                         [directions](LightRequest& r) { r.envelope_full.directions = directions; }));
  return steps;
}

std::vector<MethodStep> auto_steps() {
  std::vector<MethodStep> steps;
  for (const int percent : {20, 10, 5})
    steps.push_back(step(Method::kAuto, "tolerance " + std::to_string(percent) + " %",
                         [percent](LightRequest& r) { r.automatic.tolerance = 0.01 * percent; }));
  return steps;
}

}  // namespace

std::vector<MethodStep> method_ladder(Method method) {
  switch (method) {
    case Method::kReference:
      return reference_steps();
    case Method::kGrid:
      return grid_steps();
    case Method::kLinks:
      return links_steps();
    case Method::kEnvelopeFull:
      return envelope_steps();
    case Method::kAuto:
      return auto_steps();
    default:
      return {step(method, "default")};
  }
}

std::vector<MethodStep> method_ladders(const std::string& names) {
  std::vector<MethodStep> steps;
  const auto add = [&](const std::string& name) {
    for (MethodStep& s : method_ladder(method_from_string(name, "--methods"))) steps.push_back(std::move(s));
  };
  if (names == "all") {
    for (const std::string& name : method_names()) add(name);
    return steps;
  }
  std::istringstream in(names);
  for (std::string name; std::getline(in, name, ',');) add(name);
  return steps;
}

}  // namespace sunfleck
