// How far the closed forms of lighting/slab are from the truth in the slab they are made for: the figures of
// [SPP] Tables 1 and 2.
//
// The paper prints "RMS errors ... averaged over a number of directions and depth values, normalized by the
// total power" and leaves unsaid which directions of the beam, which depths, and how the beam itself, which
// has no width, counts as power. Read here as: radiance in `sphere_bins` equal parts of the sphere, the beam
// spread over one of them, sqrt(sum (I - I_true)^2 / sum I_true^2), sums over bins, depths and beams. Most of
// that power is the beam, which both sides have alike: a method without any scattering scores well by it.
// Scored on scattered light alone the same solutions are tens of percent off.
#pragma once

#include "lighting/bench/slab_truth.h"

namespace sunfleck {

struct SlabScore {
  double published_way = 0;  // with the beam in the denominator
  double scattered = 0;      // sqrt(sum (I - I_true)^2 / sum I_true^2) of scattered light alone
};

struct SlabErrors {
  SlabScore simplified;  // "S": uniform in each hemisphere, spp.h
  SlabScore refined;     // "R": integrated along each direction, refined_slab.h
  SlabScore only_beam;   // no scattered light at all: what the metric makes of nothing
};

struct SlabMetric {
  double sphere_bins = 500;
  double deepest = 10;  // levels of the problem beyond this depth do not count
};

SlabErrors slab_errors(const SlabProblem& problem, const SlabMetric& metric, const RunControl& control);

}  // namespace sunfleck
