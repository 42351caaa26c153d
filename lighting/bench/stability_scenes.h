// The stress list: scenes at the limits, with what is known about their light.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lighting/plan/light_request.h"

namespace sunfleck {

// A forest and its light.
struct LitForest {
  Forest forest;
  OpticsRequest optics;
  Illumination light;
};

struct StabilityScene {
  std::string name;
  LitForest lit;
  bool refuse = false;  // must be refused with Error
  // What is compared, if anything: a figure of the answer with a number known on paper, or with the same
  // figure of a twin by the same method.
  std::string figure;
  std::function<double(const LightMap&)> value;
  std::optional<double> known;
  std::optional<LitForest> twin;
  double light_there_is = 1;  // what a difference is relative to where the known value is 0
  double allowed = 0;         // relative
};

std::vector<StabilityScene> stability_scenes();

// The light of a band's mean element, front and back together: all of it, or one part.
double mean_light(const LightMap& map);
double mean_part(const LightMap& map, float FaceLight::*part);

}  // namespace sunfleck
