// The net of parameter values that a fit looks at, and the emulated light there.
#pragma once

#include <vector>

#include "lighting/study/light_emulator.h"

namespace sunfleck {

struct ParameterNet {
  std::vector<std::vector<double>> axis;   // places along each axis, evenly in its scale
  std::vector<std::vector<double>> light;  // [place; the last axis fastest][sensor]

  explicit ParameterNet(const LightEmulator& emulator);
  std::size_t size() const { return light.size(); }
  std::size_t step_of(std::size_t place, std::size_t axis_number) const;
  double value(std::size_t place, std::size_t axis_number) const;
};

}  // namespace sunfleck
