#include "lighting/study/parameter_net.h"

namespace sunfleck {
namespace {

constexpr std::size_t kSteps[] = {201, 51};

std::vector<double> spread(const std::vector<double>& nodes, std::size_t steps) {
  std::vector<double> places;
  for (std::size_t i = 0; i < steps; ++i)
    places.push_back(nodes.front() + (nodes.back() - nodes.front()) * static_cast<double>(i) /
                                         static_cast<double>(steps - 1));
  return places;
}

}  // namespace

ParameterNet::ParameterNet(const LightEmulator& emulator) {
  for (std::size_t a = 0; a < emulator.axes.size(); ++a)
    axis.push_back(spread(emulator.axes[a].nodes, kSteps[a]));
  for (const double first : axis[0]) {
    if (axis.size() == 1)
      light.push_back(emulator.at({first}));
    else
      for (const double second : axis[1]) light.push_back(emulator.at({first, second}));
  }
}

std::size_t ParameterNet::step_of(std::size_t place, std::size_t axis_number) const {
  const std::size_t inner = axis.size() == 2 ? axis[1].size() : 1;
  return axis_number == 0 ? place / inner : place % inner;
}

double ParameterNet::value(std::size_t place, std::size_t axis_number) const {
  return axis[axis_number][step_of(place, axis_number)];
}

}  // namespace sunfleck
