// The summaries a person reads after a command.
#pragma once

#include "lighting/base/light_map.h"
#include "sim/forest/forest.h"

namespace sunfleck {

void print_forest(const Forest& forest);
void print_light(const LightMap& map, const Forest& forest);

}  // namespace sunfleck
