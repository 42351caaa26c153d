// Scenes of the envelope's error table.
#pragma once

#include <functional>
#include <vector>

#include "sim/forest/forest.h"

namespace sunfleck::bench {

struct ErrorScene {
  const char* name;
  std::function<Forest(int leaves)> make;
};
// sphere of LAI 1, 2, 5, 8; clumped, cone, planophile cone; beech from its grammar; periodic stand of 9
// crowns and periodic layer.
std::vector<ErrorScene> error_scenes();

// Cell of a 4^3 grid over the forest's box that holds an element's centre.
std::vector<std::size_t> cells_of_elements(const Forest& forest);

}  // namespace sunfleck::bench
