// Whether a forest is the closed canopy that SPP-H assumes: a layer that covers its ground and loses no light
// through its sides.
//
// Two numbers say so. The crown cover is the share of the stand's ground (the period, or the box around all
// foliage) that has foliage above it, on squares of a sixteenth of the mean tree's crown. The open side share
// is the area of the stand's four sides over that of all six, 0 in a periodic scene: a cube has 0.67, a
// hectare of 20 m height 0.29, a square kilometre 0.04.
#pragma once

#include <string>

#include "lighting/slab/forest_grids.h"
#include "sim/forest/forest.h"

namespace sunfleck {

struct SppHSuitability {
  // Measured in NIR (albedo 0.9, sun at 45 degrees), bias of scattered sunlight: closed periodic canopy -3 %,
  // periodic with cover 0.42 +8 %, finite closed stand with 0.33 open sides +10 %, isolated crowns (0.67) +30
  // to +42 %.
  static constexpr double kLeastCover = 0.6, kMostOpenSides = 0.3;

  double crown_cover = 0;      // [0, 1]
  double open_side_share = 1;  // [0, 1)

  bool suitable() const { return crown_cover >= kLeastCover && open_side_share <= kMostOpenSides; }
  // A sentence with the numbers; empty where it is suitable.
  std::string reason() const;
};

SppHSuitability spp_h_suitability(const Forest& forest, const ForestGrids& grids);
SppHSuitability spp_h_suitability(const Forest& forest);

}  // namespace sunfleck
