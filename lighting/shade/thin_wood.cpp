#include "lighting/shade/thin_wood.h"

#include <cmath>

#include "sim/base/error.h"
#include "sim/base/random.h"

namespace sunfleck {

std::vector<WoodSegment> thin_wood(std::span<const WoodSegment> wood, double width_m, std::uint64_t seed) {
  if (!(width_m >= 0) || !std::isfinite(width_m))
    throw_invalid("width_m", std::to_string(width_m), "metres, at least 0");
  std::vector<WoodSegment> kept;
  for (std::size_t i = 0; i < wood.size(); ++i) {
    WoodSegment s = wood[i];
    const double own_m = static_cast<double>(s.radius_from_m) + static_cast<double>(s.radius_to_m);
    if (own_m < width_m) {
      // uniform() < own / width; never for a width of nothing.
      if (RandomStream(seed, i, RandomPurpose::kWoodThinning).uniform() * width_m >= own_m) continue;
      const auto wider = static_cast<float>(width_m / own_m);
      s.radius_from_m *= wider, s.radius_to_m *= wider;
    }
    kept.push_back(s);
  }
  return kept;
}

}  // namespace sunfleck
