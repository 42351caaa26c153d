// The inventory crown "8E": eight eighths of ellipsoids that meet at the height of the largest radius.
//
// North, east, south and west have a radius each; within a quadrant the horizontal section is a quarter of
// an ellipse between the two. Above the widest height the crown narrows as half an ellipsoid up to the top,
// below it down to the base. An eighth may have no height (widest = base): it then holds nothing.
#pragma once

#include <array>

#include "sim/base/random.h"
#include "sim/base/vec.h"
#include "sim/plant/make_prototype.h"

namespace sunfleck {

// One eighth: the points widest + (x semi.x, y semi.y, z semi.z) with (x, y, z) in the positive octant of
// the unit ball; the semi-axes carry the signs of the octant.
struct CrownEighth {
  Vec3 semi_axes_m;
  double volume_m3;
};
std::array<CrownEighth, 8> crown_eighths(const CrownShape& crown);

// True inside or on the crown's surface, with a tolerance relative to the radii.
bool inside_crown(const CrownShape& crown, const Vec3& point_m, double tolerance = 0.0);

// Points spread over the volume, evenly or with a density that grows as the distance from the crown's middle
// (as a share of the way to its surface) to the power `rim_power` >= 0, times the height above the crown's
// base (as a share of the crown's length) to the power `height_power` >= 0. `share` in [0, 1) picks the
// eighth by volume (equal steps of share spread over the eighths exactly, where height_power is 0), the rest
// is random within it.
class CrownSampler {
 public:
  explicit CrownSampler(const CrownShape& crown, double rim_power = 0, double height_power = 0);
  Vec3 sample(double share, RandomStream& random) const;

 private:
  Vec3 even_with_rim(double share, RandomStream& random) const;

  double base_m_, length_m_, widest_m_, rim_power_, height_power_;
  std::array<CrownEighth, 8> eighths_;
  std::array<double, 8> volume_to_here_m3_;  // summed up to and with each eighth
};

// Throws Error(kInvalidInput) at `where`: not finite, radius <= 0, base < 0, or not base <= widest <= height
// with base < height.
void validate(const CrownShape& crown, const std::string& where);

}  // namespace sunfleck
