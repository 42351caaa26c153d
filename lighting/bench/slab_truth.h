// Light in a plane-parallel slab lit by a beam, without the approximations of the closed forms: the yardstick
// for [SPP] Tables 1 and 2. Discrete directions and Fourier modes in azimuth, layers doubled from a thickness
// where one scattering is all there is, then added.
//
// Depths are optical depths along the slab's normal, counted from the lit side; nothing comes back from
// behind the slab. Scattering by Henyey and Greenstein ([SPP] Eq. 2). The fluence of the beam at the lit side
// is 1. 16 directions per hemisphere: albedo of a half-space of isotropic scatterers within 1e-6 of
// Chandrasekhar's, fluxes of forward scatterers (asymmetry .75) within 1e-4 of van de Hulst's.
#pragma once

#include <cstddef>
#include <vector>

#include "lighting/bench/slab_phase.h"
#include "sim/base/run_control.h"

namespace sunfleck {

struct SlabProblem {
  double albedo = 0.9;               // of one scattering, [0, 1]
  double asymmetry = 0;              // mean cosine of scattering, (-0.8, 0.8)
  double thickness = 10;             // > 0
  int layers = 10;                   // the answer is given at layers + 1 even depths, 0 .. thickness
  std::vector<double> beam_cosines;  // to the slab's normal, (0, 1]
  int directions = 16;               // per hemisphere, 4 .. 32
};

// Scattered light only: the beam, e^-(depth / cosine), is apart.
class SlabField {
 public:
  // The cosines, ascending, and their weights; the weights of a hemisphere sum to 1.
  const std::vector<double>& cosines() const { return cosines_; }
  const std::vector<double>& weights() const { return weights_; }
  std::size_t levels() const { return levels_; }

  // Radiance, per sr, that travels down (with the beam) or up along cosine `node`, `azimuth_rad` from the
  // beam's.
  double down(std::size_t beam, std::size_t level, std::size_t node, double azimuth_rad) const;
  double up(std::size_t beam, std::size_t level, std::size_t node, double azimuth_rad) const;

  // Of a level, per fluence of the beam: integrals of radiance (times its cosine) over a hemisphere.
  struct Sums {
    double fluence_down = 0, fluence_up = 0, flux_down = 0, flux_up = 0;
  };
  Sums sums(std::size_t beam, std::size_t level) const;

 private:
  friend SlabField solve_slab(const SlabProblem&, const RunControl&);
  double value(std::size_t mode, std::size_t level, std::size_t row, std::size_t beam) const {
    return modes_[mode][(level * 2 * cosines_.size() + row) * beams_ + beam];
  }
  double radiance(std::size_t beam, std::size_t level, std::size_t row, double azimuth_rad) const;

  std::vector<double> cosines_, weights_;
  std::size_t levels_ = 0, beams_ = 0;
  std::vector<std::vector<double>> modes_;  // [mode][level][down nodes, up nodes][beam]
};

SlabField solve_slab(const SlabProblem& problem, const RunControl& control);

}  // namespace sunfleck
