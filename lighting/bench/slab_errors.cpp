#include "lighting/bench/slab_errors.h"

#include <cmath>

#include "lighting/slab/refined_slab.h"
#include "lighting/slab/spp.h"
#include "sim/base/vec.h"

namespace sunfleck {
namespace {

constexpr int kAzimuths = 28;  // over half a turn: squares of 25 Fourier modes are summed exactly

// Sums of squares of one solution's errors and of the truth.
struct Squares {
  double simplified = 0, refined = 0, truth = 0, beam = 0;
};

// A depth under one beam.
struct Level {
  const SlabProblem& problem;
  std::size_t beam, level;

  double mu0() const { return problem.beam_cosines[beam]; }
  double depth() const { return problem.thickness * static_cast<double>(level) / problem.layers; }
  // Along the beam.
  double before() const { return depth() / mu0(); }
  double behind() const { return (problem.thickness - depth()) / mu0(); }
  SlabMedium<double> medium() const {
    return {1.0 - problem.albedo, 1.0 - forward_share(problem.asymmetry, mu0()), 0.0};
  }
};

// Of the light scattered at a point what goes on along cosine `mu` downwards or upwards, [SPP] A.2 (S+, S-).
ScatterShares shares(const Level& at, double mu, bool downwards, double azimuth_rad) {
  const double g = at.problem.asymmetry, forward = forward_share(g, mu), along = downwards ? mu : -mu;
  const double sines = std::sqrt((1.0 - mu * mu) * (1.0 - at.mu0() * at.mu0()));
  const double to_beam = along * at.mu0() + sines * std::cos(azimuth_rad);
  const double same = forward / (2.0 * kPi), other = (1.0 - forward) / (2.0 * kPi);
  return {downwards ? same : other, downwards ? other : same, henyey_greenstein(g, to_beam)};
}

void add_direction(const Level& at, const SlabField& truth, const RefinedSlab& refined, double simplified,
                   std::size_t node, bool downwards, Squares& squares) {
  const double mu = truth.cosines()[node];
  const SlabLine line{downwards ? mu : -mu, at.mu0() / mu, 1e300, false};
  const double weight = truth.weights()[node] * 2.0 * kPi / kAzimuths;
  for (int a = 0; a < kAzimuths; ++a) {
    const double azimuth = kPi * (a + 0.5) / kAzimuths;
    const double true_radiance =
        downwards ? truth.down(at.beam, at.level, node, azimuth) : truth.up(at.beam, at.level, node, azimuth);
    const double radiance = refined.radiance(line, shares(at, mu, downwards, azimuth));
    squares.truth += weight * true_radiance * true_radiance;
    squares.simplified += weight * std::pow(simplified - true_radiance, 2);
    squares.refined += weight * std::pow(radiance - true_radiance, 2);
  }
}

void add_level(const Level& at, const SlabField& truth, double sphere_bins, Squares& squares) {
  const SlabLight<double> light = spp(at.before(), at.behind(), at.medium());
  const RefinedSlab refined(at.before(), at.behind(), at.medium());
  for (std::size_t node = 0; node < truth.cosines().size(); ++node)
    for (const bool downwards : {true, false})
      add_direction(at, truth, refined, (downwards ? light.down : light.up) / (2.0 * kPi), node, downwards,
                    squares);
  // The beam in a bin of 4 pi / bins: radiance e^-t bins / (4 pi), squared, times the bin.
  squares.beam += light.direct * light.direct * sphere_bins / (4.0 * kPi);
}

SlabScore score(double error, const Squares& squares) {
  return {std::sqrt(error / (squares.truth + squares.beam)), std::sqrt(error / squares.truth)};
}

}  // namespace

SlabErrors slab_errors(const SlabProblem& problem, const SlabMetric& metric, const RunControl& control) {
  const SlabField truth = solve_slab(problem, control);
  Squares squares;
  for (std::size_t beam = 0; beam < problem.beam_cosines.size(); ++beam)
    for (std::size_t level = 0; level < truth.levels(); ++level) {
      control.check();
      const Level at{problem, beam, level};
      if (at.depth() <= metric.deepest * (1.0 + 1e-9)) add_level(at, truth, metric.sphere_bins, squares);
    }
  return {score(squares.simplified, squares), score(squares.refined, squares), score(squares.truth, squares)};
}

}  // namespace sunfleck
