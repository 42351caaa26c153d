// A bough of needles as a volume with a closed-form optical depth: level 3 of the pine shaders of [Meyer00],
// in Poisson form.
//
// The bough: whorls of needles (cone.h) at equal spacing along +z, apex of the first at the origin. Needles
// are taken as placed at random in azimuth, so at distance rho from the axis a ray w meets needles at a rate
//   sigma(rho, phi, w) = N r |sin(a(phi), w)| / (pi spacing sin(aperture) rho)      per length,
// a(phi) the needle direction at that azimuth. [Meyer00] adds up opacities instead (bough_linear.h), which
// fails from nA = 0.1 on; their own bough has nA = 2. Inside: rho < R + r, R = length sin(aperture), and,
// unless endless, -spacing/2 <= z - rho cot(aperture) <= (cones - 1/2) spacing, which keeps the needle count.
//
// With t the position along the ray across the axis, y the ray's distance from the axis and u = t / rho the
// depth is scale (G(u1) - G(u0)), G(u) = int sqrt(1 - (C + S u)^2) / (1 - u^2) du. The sheet tabulates G;
// here it is integrated in closed form, with beta = acos(C + S u) the angle between needle and ray, a-+ =
// |zenith
// -+ aperture|:
//   G = -S beta - sin(a-)/2 ln [sin((beta - a-)/2) / sin((beta + a-)/2)]
//               + sin(a+)/2 ln [sin((a+ - beta)/2) / sin((a+ + beta)/2)]
// arranged so that nothing cancels. No table, no build time, exact to rounding for every aperture.
//
// Where it stops being true: whorls must overlap along the axis (length cos(aperture) of 2 spacings or more).
// Then, needles being regular round the axis, real boughs are a little more opaque (up to .04 at nA 1 to 6).
// Flat whorls that stand apart, one above the other, are off by up to .11 in opacity. Single scattering. Rays
// within kLeastSine of the axis are bent to that angle. Lengths in one unit throughout (metres in the
// renderer); frame: that of the bough, axis +z.
#pragma once

#include <array>

#include "lighting/shade/cone.h"
#include "sim/base/vec.h"

namespace sunfleck {

struct Bough {
  NeedleCone cone;
  double spacing = 0.1;
  int cones = 0;  // 0: endless in both directions
  // Needles near the one seen shade it less when the light comes from the viewer: correlation length of the
  // hot spot in needle radii. 2 fits light within 5 degrees of the viewer, 4 all other angles; 0: none.
  double hot_spot_radii = 4;
};
// Throws Error(kInvalidInput) that names `where`.
void validate(const Bough& bough, const char* where);

// What rays need of a bough.
struct BoughVolume {
  double sin_aperture = 0, cos_aperture = 1;
  double outer_radius = 0;  // R + r
  double density = 0;       // sigma = density sin(a, w) / rho
  double hot_spot_length = 0;
  double lowest = 0, highest = 0;  // of z - rho cot(aperture); infinite when endless
};
BoughVolume bough_volume(const Bough& bough);

// Smallest sine of the angle between a ray and the axis (0.06 degrees).
inline constexpr double kLeastSine = 1e-3;

// A direction prepared for a bough: all that does not depend on where the ray runs.
struct BoughDirection {
  Vec3 along{1, 0, 0};                          // unit; at least kLeastSine off the axis
  Vec2 across{1, 0};                            // unit, of its part across the axis
  double sine = 1;                              // of the angle to the axis
  double constant = 0, slope = 0;               // C = cos aperture cos zenith, S = sin aperture sin zenith
  double one_minus_near = 0, one_plus_far = 0;  // 1 - cos(a-), 1 + cos(a+)
  double plus_near = 0, minus_near = 0;         // sqrt(1 + cos(a-)), sqrt(1 - cos(a-))
  double plus_far = 0, minus_far = 0;           // the same of a+
  double sin_near = 0, sin_far = 0;             // sin(a-), sin(a+)
  double scale = 0;                             // density / sine
};
BoughDirection bough_direction(const BoughVolume& volume, const Vec3& direction);

// Stretches of a ray (in lengths from its origin, from >= 0) inside the bough; at most two.
struct BoughSpans {
  struct Span {
    double from = 0, to = 0;
  };
  int count = 0;
  std::array<Span, 2> span{};
};
BoughSpans bough_spans(const BoughVolume& volume, const Vec3& origin, const BoughDirection& direction);

// Optical depth from the origin (anywhere) to infinity; exp(-depth) is the expected share of light that comes
// through. About 0.1 us.
double bough_depth(const BoughVolume& volume, const Vec3& origin, const BoughDirection& direction);
double bough_depth(const BoughVolume& volume, const Vec3& origin, const BoughDirection& direction,
                   const BoughSpans& spans);
// needles met per length by a ray at this point.
double bough_extinction(const BoughVolume& volume, const Vec3& point, const BoughDirection& direction);

}  // namespace sunfleck
