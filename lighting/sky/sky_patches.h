// The hemisphere cut into patches of known solid angle: rings of equal height in cos(zenith), each ring cut
// into equal azimuths, as many as make the patches about square. A sky of any kind becomes one mean radiance
// per patch.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/base/vec.h"

namespace sunfleck {

// One direction per patch. to_source.z is the patch's mean of cos(zenith), so that the sum of
// solid_angle_sr * to_source.z is pi, without error, and a horizontal plane gets each patch's light exactly.
// Solid angles sum to 2 pi.
struct SkyDirections {
  std::vector<Vec3> to_source;         // unit, z > 0
  std::vector<double> solid_angle_sr;  // > 0, one per direction

  std::size_t size() const { return to_source.size(); }
};

}  // namespace sunfleck
