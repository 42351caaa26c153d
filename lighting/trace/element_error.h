// Standard error of one element's light: the spread of its own rays, the noise that the radiosities they met
// carry, and the shadow rays.
#pragma once

#include "lighting/trace/radiosity.h"

namespace sunfleck::trace {

// Of the mean over a face's own rays, (W m-2)^2. `typical_radiosity_w_m2` stands for what a ray that has not
// been seen yet would meet, where all rays so far met surfaces, or none did.
double own_ray_variance(const BandProblem& problem, const Radiosity<1>& radiosity, std::size_t face,
                        double typical_radiosity_w_m2);

// Evenly spread points err by less than their spread says. How much less is seen over many faces together:
// the variance of the groups' means (jackknife.h) over that of independent rays, 1 for few rays.
struct SpreadGains {
  double rays = 1, sun_rays = 1;  // of own_ray_variance and sun_variance
};
// Needles are met by lot, which no spread of the rays evens out: shoots have gains of their own.
struct ShapeGains {
  SpreadGains leaves, shoots;
};
ShapeGains spread_gains(const BandProblem& problem, const Radiosity<1>& radiosity);
bool is_shoot(const Receivers& receivers, std::size_t element);

// Of a visible fraction of which `seen` of `rays` were visible: binomial around (seen + 1/2) / (rays + 1), so
// that no run of equal outcomes claims certainty (Jeffreys' prior).
double fraction_variance(double seen, double rays);

// Of the direct light on both faces of a foliage element together.
double sun_variance(const BandProblem& problem, std::size_t element, const Vec3& to_sun);

}  // namespace sunfleck::trace
