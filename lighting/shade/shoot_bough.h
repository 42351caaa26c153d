// The bough that stands for a shoot of needles: its needles (sim/plant/needles.h) as the volume of bough.h.
//
// Needles lean at one angle round the shoot's axis and begin at equal steps along it: whorls of one needle.
// They begin a little off the axis (at 8 % of the radius), which the volume does not know: its needles begin
// on the axis and are so much longer, and thinner sown, that needle area and rim stay. As in bough.h the
// volume is a needle's radius wider than the rim, and so much (4 % in spruce) more of it. Needles
// combed into a plane (fir) or standing in tufts (larch) become round brushes of the same area.
#pragma once

#include "lighting/shade/bough.h"
#include "sim/plant/needles.h"

namespace sunfleck {

struct ShootBough {
  BoughVolume volume;                              // metres
  Vec3 origin_m{0};                                // of the bough's frame, in the coordinates of the shoot
  Vec3 axis{0, 0, 1}, side{1, 0, 0}, up{0, 1, 0};  // unit, right-handed: side x up = axis

  Vec3 into_bough(const Vec3& v) const { return {glm::dot(v, side), glm::dot(v, up), glm::dot(v, axis)}; }
  Vec3 out_of_bough(const Vec3& v) const { return v.x * side + v.y * up + v.z * axis; }
};

// Expects a shoot and a template of shoots. A shoot of no extent gets a bough of no density.
ShootBough shoot_bough(const FoliageElement& shoot, const FoliageTemplate& foliage,
                       double hot_spot_radii = 3.0);

}  // namespace sunfleck
