// Adding and doubling; see slab_truth.h. Each Fourier mode m of azimuth is a problem of its own:
//   mu dI/dz = -I + albedo [ 2 pi sum_j w_j p_m(mu, mu_j) I(mu_j) + (2 - [m = 0]) p_m(mu, mu0) e^(-z / mu0) ]
#include "lighting/bench/slab_truth.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lighting/bench/small_matrix.h"
#include "sim/base/contract.h"
#include "sim/base/vec.h"

namespace sunfleck {
namespace {

constexpr double kThinnest = 1e-7;      // of a layer in which light is scattered once at most
constexpr double kSmallestTerm = 1e-8;  // of the phase function's series

// p_m(mu, mu') of the phase function, per sr.
struct PhaseMode {
  std::size_t mode, last;
  double asymmetry;

  double operator()(double mu, double other) const {
    const std::vector<double> a = legendre_row(mode, last, mu), b = legendre_row(mode, last, other);
    double sum = 0.0;
    for (std::size_t l = mode; l <= last; ++l)
      sum += (2.0 * static_cast<double>(l) + 1.0) * std::pow(asymmetry, static_cast<double>(l)) * a[l] * b[l];
    return sum / (4.0 * kPi);
  }
};

// What a layer does to the light on its border, and what of the beam (1 at its top) it sends out.
struct Layer {
  SmallMatrix reflected, passed, source_down, source_up;
  std::vector<double> beam;  // the share of each that passes
};

Layer thin_layer(const SlabProblem& problem, const GaussRule& rule, const PhaseMode& phase, double depth) {
  const std::size_t n = rule.points.size(), beams = problem.beam_cosines.size();
  Layer layer{{n, n}, {n, n}, {n, beams}, {n, beams}, {}};
  for (std::size_t i = 0; i < n; ++i) {
    const double mu = rule.points[i], scattered = -std::expm1(-depth / mu) * problem.albedo;
    for (std::size_t j = 0; j < n; ++j) {
      const double weight = scattered * 2.0 * kPi * rule.weights[j];
      layer.reflected.at(i, j) = weight * phase(-mu, rule.points[j]);
      layer.passed.at(i, j) = (i == j ? std::exp(-depth / mu) : 0.0) + weight * phase(mu, rule.points[j]);
    }
    for (std::size_t b = 0; b < beams; ++b) {
      const double share = scattered * (phase.mode == 0 ? 1.0 : 2.0);
      layer.source_down.at(i, b) = share * phase(mu, problem.beam_cosines[b]);
      layer.source_up.at(i, b) = share * phase(-mu, problem.beam_cosines[b]);
    }
  }
  for (const double mu0 : problem.beam_cosines) layer.beam.push_back(std::exp(-depth / mu0));
  return layer;
}

// Light between two bodies: `down` is what the upper sends down by itself, `up` what the lower sends up, each
// reflects the other's.
struct Between {
  SmallMatrix down, up;
};
Between between(const SmallMatrix& upper_reflects, const SmallMatrix& down, const SmallMatrix& lower_reflects,
                const SmallMatrix& up) {
  Between light;
  light.down = solve_one_minus(upper_reflects * lower_reflects, down + upper_reflects * up);
  light.up = up + lower_reflects * light.down;
  return light;
}

// Reflection of a layer with a body behind it, seen from the layer's other side.
SmallMatrix reflected_with(const Layer& layer, const SmallMatrix& body_reflects) {
  return layer.reflected +
         layer.passed * (body_reflects * solve_one_minus(layer.reflected * body_reflects, layer.passed));
}

Layer doubled(const Layer& one) {
  const Between light =
      between(one.reflected, one.source_down, one.reflected, scaled_columns(one.source_up, one.beam));
  Layer two;
  two.reflected = reflected_with(one, one.reflected);
  two.passed = one.passed * solve_one_minus(one.reflected * one.reflected, one.passed);
  two.source_down = scaled_columns(one.source_down, one.beam) + one.passed * light.down;
  two.source_up = one.source_up + one.passed * light.up;
  two.beam = one.beam;
  for (double& b : two.beam) b *= b;
  return two;
}

Layer layer_of(const SlabProblem& problem, const GaussRule& rule, const PhaseMode& phase,
               const RunControl& control) {
  const double depth = problem.thickness / problem.layers;
  const int doublings = std::max(0, static_cast<int>(std::ceil(std::log2(depth / kThinnest))));
  Layer layer = thin_layer(problem, rule, phase, std::ldexp(depth, -doublings));
  for (int i = 0; i < doublings; ++i) {
    control.check();
    layer = doubled(layer);
  }
  return layer;
}

// What lies above a level (reflecting down, sending down) or below it (reflecting up, sending up).
struct Body {
  SmallMatrix reflects, sends;
};

// [number of layers]; beam 1 at the slab's top.
std::vector<Body> bodies_above(const Layer& layer, int layers) {
  const std::size_t n = layer.reflected.rows, beams = layer.beam.size();
  std::vector<Body> bodies{{SmallMatrix(n, n), SmallMatrix(n, beams)}};
  std::vector<double> beam(beams, 1.0);
  for (int k = 0; k < layers; ++k) {
    const Body& last = bodies.back();
    const Between light =
        between(last.reflects, last.sends, layer.reflected, scaled_columns(layer.source_up, beam));
    Body next{reflected_with(layer, last.reflects),
              scaled_columns(layer.source_down, beam) + layer.passed * light.down};
    for (std::size_t b = 0; b < beams; ++b) beam[b] *= layer.beam[b];
    bodies.push_back(std::move(next));
  }
  return bodies;
}

// [number of layers]; beam 1 at the body's own top.
std::vector<Body> bodies_below(const Layer& layer, int layers) {
  const std::size_t n = layer.reflected.rows;
  std::vector<Body> bodies{{SmallMatrix(n, n), SmallMatrix(n, layer.beam.size())}};
  for (int k = 0; k < layers; ++k) {
    const Body& last = bodies.back();
    const Between light =
        between(layer.reflected, layer.source_down, last.reflects, scaled_columns(last.sends, layer.beam));
    bodies.push_back({reflected_with(layer, last.reflects), layer.source_up + layer.passed * light.up});
  }
  return bodies;
}

// [level][down nodes, up nodes][beam]
std::vector<double> solve_mode(const SlabProblem& problem, const GaussRule& rule, const PhaseMode& phase,
                               const RunControl& control) {
  const Layer layer = layer_of(problem, rule, phase, control);
  const std::vector<Body> above = bodies_above(layer, problem.layers),
                          below = bodies_below(layer, problem.layers);
  std::vector<double> light;
  std::vector<double> beam(layer.beam.size(), 1.0);
  for (std::size_t k = 0; k < above.size(); ++k) {
    const Body& lower = below[above.size() - 1 - k];
    const Between at =
        between(above[k].reflects, above[k].sends, lower.reflects, scaled_columns(lower.sends, beam));
    light.insert(light.end(), at.down.values.begin(), at.down.values.end());
    light.insert(light.end(), at.up.values.begin(), at.up.values.end());
    for (std::size_t b = 0; b < beam.size(); ++b) beam[b] *= layer.beam[b];
  }
  return light;
}

}  // namespace

double SlabField::radiance(std::size_t beam, std::size_t level, std::size_t row, double azimuth_rad) const {
  double sum = 0.0;
  for (std::size_t m = 0; m < modes_.size(); ++m)
    sum += value(m, level, row, beam) * std::cos(static_cast<double>(m) * azimuth_rad);
  return sum;
}

double SlabField::down(std::size_t beam, std::size_t level, std::size_t node, double azimuth_rad) const {
  return radiance(beam, level, node, azimuth_rad);
}

double SlabField::up(std::size_t beam, std::size_t level, std::size_t node, double azimuth_rad) const {
  return radiance(beam, level, cosines_.size() + node, azimuth_rad);
}

SlabField::Sums SlabField::sums(std::size_t beam, std::size_t level) const {
  Sums sums;
  for (std::size_t i = 0; i < cosines_.size(); ++i) {
    const double down = 2.0 * kPi * weights_[i] * value(0, level, i, beam);
    const double up = 2.0 * kPi * weights_[i] * value(0, level, cosines_.size() + i, beam);
    sums.fluence_down += down;
    sums.fluence_up += up;
    sums.flux_down += cosines_[i] * down;
    sums.flux_up += cosines_[i] * up;
  }
  return sums;
}

SlabField solve_slab(const SlabProblem& problem, const RunControl& control) {
  SUNFLECK_EXPECTS(problem.albedo >= 0.0 && problem.albedo <= 1.0 && problem.thickness > 0.0);
  SUNFLECK_EXPECTS(std::abs(problem.asymmetry) < 0.8 && problem.layers >= 1);
  SUNFLECK_EXPECTS(problem.directions >= 4 && problem.directions <= 32);
  for (const double mu0 : problem.beam_cosines) SUNFLECK_EXPECTS(mu0 > 0.0 && mu0 <= 1.0);
  // The rule sums products of the series' terms with even light exactly up to this one: nothing is lost.
  std::size_t last = 0;
  while (std::pow(std::abs(problem.asymmetry), static_cast<double>(last + 1)) > kSmallestTerm &&
         last + 1 < 2 * static_cast<std::size_t>(problem.directions))
    ++last;
  GaussRule rule = gauss_rule(problem.directions);
  SlabField field;
  for (std::size_t m = 0; m <= last; ++m)
    field.modes_.push_back(solve_mode(problem, rule, {m, last, problem.asymmetry}, control));
  field.levels_ = static_cast<std::size_t>(problem.layers) + 1;
  field.beams_ = problem.beam_cosines.size();
  field.cosines_ = std::move(rule.points);
  field.weights_ = std::move(rule.weights);
  return field;
}

}  // namespace sunfleck
