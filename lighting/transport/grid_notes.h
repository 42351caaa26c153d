// Which limits of the grid method a scene touches, in sentences for the user.
#pragma once

#include <string>
#include <vector>

#include "lighting/transport/transport_scene.h"

namespace sunfleck::transport {

// Prototypes with fewer elements than this are no random medium: rays are the better choice.
inline constexpr std::size_t kFewElements = 300;
// Cells smaller than this many leaf sides light and shade a leaf by itself.
inline constexpr double kFewestSides = 1.5;

std::vector<std::string> grid_notes(const Forest& forest, const TransportScene& scene);

}  // namespace sunfleck::transport
