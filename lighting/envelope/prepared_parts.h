// What prepare_envelope() keeps.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lighting/base/light_map.h"
#include "lighting/depth/extinction_grid.h"
#include "lighting/envelope/envelope_options.h"
#include "lighting/envelope/ground_cells.h"
#include "lighting/envelope/leaf_angles.h"

namespace sunfleck::envelope {

struct PreparedParts {
  EnvelopeFullOptions options;
  std::string forest_hash;
  std::unique_ptr<const BlockerField> field;
  SectorSet set;
  std::vector<float> depths;  // [element * count + direction]
  GroundCells ground;
  std::vector<float> ground_depths;                // [ground cell * count + direction]; 0 downwards
  std::vector<PrototypeAngles> angles;             // by prototype
  std::vector<std::vector<AngleMoments>> moments;  // [prototype][sample]
  std::vector<ExtinctionGrid> grids;  // of the first half of the set; none where they would be large
  std::size_t clamped = 0;            // contributions cut off at 0.9 of a cell's face, all grids together
  std::vector<StageTime> times;

  std::span<const float> depths_of(std::size_t element) const {
    return {depths.data() + element * set.count(), set.count()};
  }
};

// Optical depth from an element along a grid's direction; with or without the element itself.
std::vector<float> element_depths(const PreparedParts& parts, const Forest& forest, const ForestIndex& index,
                                  const ExtinctionGrid& grid, March march, const RunControl& control);

}  // namespace sunfleck::envelope
