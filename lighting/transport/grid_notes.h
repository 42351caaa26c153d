// Which limits of the grid method a scene touches, in sentences for the user.
#pragma once

#include <string>
#include <vector>

#include "lighting/transport/grid_limits.h"
#include "lighting/transport/transport_scene.h"

namespace sunfleck::transport {

std::vector<std::string> grid_notes(const Forest& forest, const TransportScene& scene);

}  // namespace sunfleck::transport
