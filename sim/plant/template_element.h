// The foliage element of a species, made to an area and put somewhere.
#pragma once

#include "sim/plant/prototype.h"
#include "sim/plant/species.h"

namespace sunfleck {

// A leaf: rectangle of the species' length to width with this unit front normal, its length turned by
// `turn_rad` about it. A shoot: the species' shoot scaled in all directions (needle area per volume stays),
// its axis in the plane of the normal. area_m2 > 0.
FoliageElement template_element(const FoliageTemplate& foliage, double area_m2, const Vec3& centre_m,
                                const Vec3& normal, double turn_rad);

}  // namespace sunfleck
