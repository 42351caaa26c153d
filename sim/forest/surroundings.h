// What stands around an inventoried plot. Trees beyond its border shade it and were not measured; without
// them a plot is an island in full light.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/forest/forest_spec.h"

namespace sunfleck {

std::string to_string(Surroundings kind);  // "none", "periodic", "mirrored", "similar"

struct SurroundedStand {
  std::vector<InventoryTree> trees;  // those given first; added ones have virtual numbers
  std::optional<Period> period;
  std::vector<std::string> notes;
};

// none: as given. periodic: the plot's bounding rectangle repeats; where the polygon does not fill it, trees
// drawn as for `similar` do, so that the repeated stand is closed. mirrored: every tree within `width_m` of a
// side of the bounding rectangle stands a second time beyond it (corners too); polygons must fill their
// rectangle to 90 %. similar: trees drawn from the plot's own (with all their measures, turned by quarters
// about their stem) stand in a strip of `width_m` around the plot at its density and basal area, no closer to
// others than a tenth of all measured neighbours are; reproducible by `seed`. Width 0: as far as the
// 90th-percentile tree's shade reaches under a sun 15 degrees high.
// Throws Error(kInvalidInput): mirrored with a ragged polygon, width negative.
SurroundedStand surround(const std::vector<InventoryTree>& trees, const PlotPolygon& plot, Surroundings kind,
                         double width_m, std::uint64_t seed);

}  // namespace sunfleck
