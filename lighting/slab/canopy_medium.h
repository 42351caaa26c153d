// What the closed form has to know of a prototype's leaves and wood in a band: how much they absorb and how
// much they send back.
#pragma once

#include <cstdint>
#include <vector>

#include "lighting/optics/optics.h"
#include "lighting/slab/spp.h"
#include "sim/forest/forest.h"

namespace sunfleck {

// Mean over leaves and wood weighted by the area they show to light from everywhere (one-sided leaf area;
// half of a cylinder's surface, which reflects as bark and lets nothing through).
struct CanopyOptics {
  double absorption = 1;  // 1 - r - t
  double turn = 0;        // q = (r - t) / (r + t)

  // For light from a direction with turn ratio <(n.s)^2> / <|n.s|> over the leaves, measured from their
  // normals: R = 1/2 + q/2 of that ratio, exact for bi-Lambertian leaves and a slab across the light.
  SlabMedium<double> medium(double turn_ratio, double ground_albedo) const;
};

// [band][prototype]
std::vector<std::vector<CanopyOptics>> canopy_optics(const Forest& forest, const OpticsTable& optics);

}  // namespace sunfleck
