// The baked picture of all planes of a billboard cloud. Private to the folder.
#pragma once

#include "lighting/shade/billboard_cloud.h"

namespace sunfleck {

// Where a plane lies in the picture, texels from its upper left corner; v runs downwards.
struct AtlasPlace {
  int x = 0, y = 0, width = 0, height = 0;
};

struct BillboardAtlas {
  int side_px = 0;
  double texel_m = 0;
  std::vector<AtlasPlace> place;    // per plane
  std::vector<std::uint8_t> cover;  // side x side: share of the texel that leaves cover, in 255ths
};
// The largest scale at which all planes fit, a texel of space around each.
BillboardAtlas bake_atlas(const BillboardCloud& cloud, int side_px, const RunControl& control);

// The cover above which as much of the picture lies as leaves cover (255ths, 1 to 255), and how well.
struct AlphaCutoff {
  int least = 1;
  double kept = 1;
};
AlphaCutoff keeping_cover(const BillboardAtlas& atlas);

}  // namespace sunfleck
