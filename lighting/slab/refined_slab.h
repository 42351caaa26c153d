// The refined form of [SPP] section 3.5 and A.1: radiance that a point receives from one direction, by
// integrating what the slab solution of spp.h scatters into it along the line from the point to the boundary.
//
// Depths are optical depths along the beam. A direction looks from the point to where light comes from;
// cosine > 0 looks towards the lit side. All integrals are of falling exponentials, written as phi1 and its
// divided difference: nothing grows, nothing is divided by 0 (the printed A.1, A.2 are, at lambda = sigma).
// Relative error below 1e-11 in double.
#pragma once

#include "lighting/slab/spp.h"

namespace sunfleck {

// Shares of the light scattered at a point, per sr, that go into the direction: of the two hemispheres'
// fluence and of the beam's. 1 / (4 pi) each for isotropic scattering.
struct ScatterShares {
  double from_down = 0, from_up = 0, from_beam = 0;
};

// A line from the point.
struct SlabLine {
  double cosine = 1;  // to the light's direction, [-1, 1]
  // Optical depth along the line per depth along the beam, > 0: 1 / |cosine| where leaves show the same area
  // to all directions, as [SPP] has it.
  double rate = 1;
  // Optical depth of the line at which the leaves really end; infinity: where the slab does, as in [SPP].
  double true_end = 1e300;
  bool meets_ground = true;  // at its end, if it leads away from the light
};

class RefinedSlab {
 public:
  RefinedSlab(double before, double behind, const SlabMedium<double>& medium);

  // Radiance per fluence of the beam at the lit boundary, W m-2 sr-1 per W m-2.
  double radiance(const SlabLine& line, const ScatterShares& shares) const;

 private:
  struct Integrals {
    double cosine, sine, ground, beam;
  };
  Integrals with_beam(double length, double rate) const;
  Integrals against_beam(double length, double rate) const;

  double tau_, x_, ground_, albedo_;
  double backward_, decay_, sink_, one_minus_ground_r_;
  double to_point_, beam_, there_and_back_, sine_, per_denominator_, ground_radiance_;
};

}  // namespace sunfleck
