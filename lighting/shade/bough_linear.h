// The bough of [Meyer00] section 6 as printed: opacities of whorls are added up and shadows taken off to
// first order (1 - nA for (1 - A)^n). KEPT AS A LIMIT, NEVER FOR USE: at the paper's own bough (A = 0.235, nA
// = 2.05) its opacity is 1.6 to 1.8 and its light negative. Right for nA <= 0.1 (4 % in opacity), 0.2 (9 %).
//
// Rebuilt by derivation from the text, whose formulas are damaged: swept shadow lengths over half disks of
// radius 1, factors of A R / spacing, crossings k+-(zenith) = |cot aperture -+ cot zenith|.
#pragma once

#include "lighting/shade/bough.h"
#include "lighting/shade/bough_light.h"

namespace sunfleck {

// Mean cover of a cone's surface: 2 N r / (pi R), R = length sin(aperture).
double cone_cover(const NeedleCone& cone);

// Integrals over the front (F) and rear (R) half disk towards the viewer of the shadow ray's length in the
// front and rear half towards the light, disk of radius 1, `between` the azimuth from viewer to light
// ([Meyer00] 6.5, S1..S4 over sin lambda).
struct SweptLengths {
  double front_in_rear = 0, front_in_front = 0, rear_in_rear = 0, rear_in_front = 0;
};
SweptLengths swept_lengths(double between_rad);

// May leave [0, 1]: that is its error. Directions in the bough's frame, not along its axis.
BoughLight bough_light_linear(const Bough& bough, const Vec3& to_viewer, const Vec3& to_light);

}  // namespace sunfleck
