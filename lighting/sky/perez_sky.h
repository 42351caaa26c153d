// Perez all-weather sky: how bright each part of the sky is, from the sun's place and two numbers that tell
// how clear and how bright the weather is.
//
// [Perez93] Perez, Seals and Michalsky 1993, All-weather model for sky luminance distribution - preliminary
// configuration and validation, Solar Energy 50:235-245, with the erratum in 51:423. Fitted to luminance;
// used here for the radiance of every band, as is usual. [Perez90] Perez, Ineichen, Seals, Michalsky and
// Stewart 1990, Solar Energy 44:271-289, for clearness and brightness.
//
// The published polynomials leave the physical in corners no weather reaches (a bright sky with an overhead
// clear sun, a half-clear sky that is darker than clean air). There we keep: brightness in [0.01, 0.6], at
// least 0.2 where clearness is in [1.065, 2.8) and at least 0.05 above it (clean air scatters that much);
// gradation falling towards 0 at the horizon (b <= -0.05), a halo that fades away from the sun (d <= 0), and
// both factors >= 0.
#pragma once

#include "sim/base/vec.h"

namespace sunfleck {

struct PerezSky {
  Vec3 to_sun{0, 0, 1};     // unit; at or below the horizon counts as at it, and then the sky is overcast
  double clearness = 1;     // epsilon of [Perez90] Eq. 1: 1 overcast, above 6.2 clear
  double brightness = 0.2;  // Delta of [Perez90] Eq. 2: diffuse radiation against that outside the atmosphere
};

// Clearness and brightness of measured (or split) radiation, all in one unit. A sky without diffuse light
// counts as overcast of the least brightness.
PerezSky perez_sky(const Vec3& to_sun, double beam_normal, double diffuse_horizontal,
                   double extraterrestrial_normal);

// The direction itself, or the one at the horizon above it (north if it points straight down).
Vec3 lifted_to_horizon(const Vec3& to_sun);

// Air mass by the apparent zenith angle, 1 to 38. Kasten and Young 1989, Applied Optics 28:4735-4738.
double relative_air_mass(double zenith_rad);

// The five numbers of [Perez93] Eq. 1: radiance ~ (1 + a exp(b / cos zenith)) (1 + c exp(d g) + e cos^2 g), g
// the angle to the sun.
struct PerezShape {
  double a, b, c, d, e;
};
PerezShape perez_shape(const PerezSky& sky);
// Not normalised; the product of its two factors, both >= 0 and finite for every direction with z >= 0.
double perez_gradation(const PerezShape& shape, double cos_zenith);
double perez_halo(const PerezShape& shape, double cos_to_sun);
double perez_relative_radiance(const PerezShape& shape, double cos_zenith, double cos_to_sun);

}  // namespace sunfleck
