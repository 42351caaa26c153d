// What a prototype takes from parallel light when it stands alone, traced through its real leaves and wood,
// and what each m2 of its area must show in the boxes of a BoxCanopy to take the same: leaf angles and
// clumping below the size of a box are both in that number.
#pragma once

#include <cstdint>
#include <vector>

#include "lighting/canopy/box_canopy.h"

namespace sunfleck {

// By zenith angle of the light (from the vertical, along which trees stand), averaged over azimuth.
struct CrownOptics {
  std::vector<double> zenith_rad;      // nodes, rising
  std::vector<double> alone_m2;        // intercepted, of facing light, at scale 1
  std::vector<double> shown_per_area;  // m2 per m2 of area in boxes

  double alone_at(double zenith) const;  // linear between nodes, constant beyond
  double shown_at(double zenith) const;
};

struct CrownOpticsOptions {
  double voxel_m = 1;
  int rays = 1000;  // over a rectangle round the crown's shadow, per zenith and azimuth
  std::uint64_t seed = 1;
};

// One per prototype of the forest; prototypes that no tree uses stay empty. Progress stage "crowns alone".
std::vector<CrownOptics> crown_optics(const Forest& forest, const CrownOpticsOptions& options,
                                      const RunControl& control);

}  // namespace sunfleck
