// See closed_forms.h. Equation numbers are those of [Boulanger08]; each line that differs from print says so.
#include "lighting/envelope/closed_forms.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "sim/base/contract.h"

namespace sunfleck::envelope {

namespace {

template <class Real>
constexpr Real kPiOf = std::numbers::pi_v<Real>;

// What is missing from the double nearest to pi: pi = 3.14159265358979311600 + 1.2246e-16.
constexpr double kPiRest = 1.2246467991473532e-16;

// Series of sin x - x cos x about 0, where the two terms cancel; seven terms are exact below x = 0.7.
template <class Real>
Real lobe_series(Real x) {
  const Real y = x * x;
  Real sum = Real(1.0 / 93405312000.0);
  sum = sum * y - Real(1.0 / 518918400.0);
  sum = sum * y + Real(1.0 / 3991680.0);
  sum = sum * y - Real(1.0 / 45360.0);
  sum = sum * y + Real(1.0 / 840.0);
  sum = sum * y - Real(1.0 / 30.0);
  sum = sum * y + Real(1.0 / 3.0);
  return x * y * sum;
}

// Integral over x from 0 to `depth` of exp(-start - rate x). phi(-y) = exp(y) phi(y) keeps a negative rate
// from overflowing where the result does not.
template <class Real>
Real attenuated_span(Real start, Real rate, Real depth) {
  const Real gain = std::max(Real(0), -rate * depth);
  return std::exp(gain - start) * depth * mean_decay(std::abs(rate) * depth);
}

}  // namespace

template <class Real>
Real lobe_function(Real x) {
  return x < Real(0.7) ? lobe_series(x) : std::sin(x) - x * std::cos(x);
}

template <class Real>
Real mean_decay(Real x) {
  return x == Real(0) ? Real(1) : -std::expm1(-x) / x;
}

template <class Real>
AnglePair<Real> angle_between(const Direction<Real>& a, const Direction<Real>& b) {
  // Not acos(a.b): it loses half of the digits near 0 and pi and is NaN when rounding makes a.b > 1.
  const Real across = glm::length(glm::cross(a, b));
  const Real along = glm::dot(a, b);
  return {std::atan2(across, along), std::atan2(across, -along)};
}

AnglePair<double> angle_pair(double angle_rad) { return {angle_rad, (kPiOf<double> - angle_rad) + kPiRest}; }

template <class Real>
Real mean_transmitting_cosines(const AnglePair<Real>& angles) {
  return lobe_function(angles.supplement_rad) / (6 * kPiOf<Real>);  // Eq. 31
}

template <class Real>
Real mean_reflecting_cosines(const AnglePair<Real>& angles) {
  return lobe_function(angles.angle_rad) / (6 * kPiOf<Real>);  // Eq. 32
}

template <class Real>
Real scattering_lobe(const LeafSums<Real>& leaf, const AnglePair<Real>& angles) {
  return leaf.reflectance * lobe_function(angles.angle_rad) +
         leaf.transmittance * lobe_function(angles.supplement_rad);
}

template <class Real>
Real scattering_density(Real leaves_per_m3, int directions, const LeafSums<Real>& leaf,
                        const AnglePair<Real>& angles) {
  // Eq. 18 with its bracket gathered into two terms that cannot be negative.
  const Real per_direction = 2 * leaves_per_m3 / (3 * kPiOf<Real> * static_cast<Real>(directions));
  return per_direction * scattering_lobe(leaf, angles);
}

template <class Real>
Real interpolation_weights(std::span<const Direction<Real>> directions, const Direction<Real>& to_light,
                           std::span<Real> weights) {
  SUNFLECK_EXPECTS(!directions.empty() && weights.size() == directions.size());
  SUNFLECK_EXPECTS(std::isfinite(glm::dot(to_light, to_light)) && glm::dot(to_light, to_light) > Real(0));
  double sum = 0;
  std::size_t closest = 0;
  for (std::size_t j = 0; j < directions.size(); ++j) {
    const Real cosine = glm::dot(to_light, directions[j]);
    weights[j] = std::max(Real(0), cosine);
    sum += weights[j];
    if (cosine > glm::dot(to_light, directions[closest])) closest = j;
  }
  if (sum < 1e-6) {
    std::ranges::fill(weights, Real(0));
    weights[closest] = 1;
  } else {
    for (Real& weight : weights) weight = static_cast<Real>(weight / sum);  // Eq. 7
  }
  return static_cast<Real>(sum);
}

template <class Real>
Real interpolated(std::span<const Real> weights, std::span<const Real> values) {
  SUNFLECK_EXPECTS(weights.size() == values.size());
  double sum = 0.0;
  for (std::size_t k = 0; k < weights.size(); ++k) sum += static_cast<double>(weights[k]) * values[k];
  return static_cast<Real>(sum);
}

template <class Real>
Real approach_towards(std::span<const Direction<Real>> directions, std::span<const Real> weights,
                      std::size_t j) {
  Real sum = 0;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    sum += weights[k] * glm::dot(directions[j], directions[k]);  // Eq. 25
  }
  return sum;
}

template <class Real>
Real published_sector_sample(const PublishedSector<Real>& sector) {
  const Real decay = sector.extinction_per_m * (1 - sector.approach);  // G3, Eq. 25
  return sector.scattering_per_m3 * sector.irradiance_w_m2 *
         std::exp(-sector.extinction_per_m * sector.light_distance_m) * sector.sector_distance_m *
         mean_decay(decay * sector.sector_distance_m);  // Eq. 23
}

template <class Real>
Real one_bounce_integral(Real depth_to_light, Real approach, Real sector_depth) {
  // As far as the light's own depth stays positive Eq. 22 holds ...
  if (approach <= Real(0) || depth_to_light >= approach * sector_depth) {
    return attenuated_span(depth_to_light, 1 - approach, sector_depth);
  }
  // ... beyond, where it would turn negative, the light is not weakened at all.
  const Real turn = depth_to_light / approach;
  const Real before = attenuated_span(depth_to_light, 1 - approach, turn);
  const Real beyond = std::exp(-turn) * -std::expm1(-(sector_depth - turn));
  return before + beyond;
}

template <class Real>
Real one_bounce_sector(Real solid_angle_sr, Real lobe, Real irradiance_w_m2, Real integral) {
  return solid_angle_sr / (3 * kPiOf<Real> * kPiOf<Real>)*lobe * irradiance_w_m2 * integral;
}

template <class Real>
const std::array<Direction<Real>, 8>& cube_directions() {
  constexpr Real c = std::numbers::inv_sqrt3_v<Real>;
  static const std::array<Direction<Real>, 8> directions = {
      {{-c, -c, -c}, {c, -c, -c}, {-c, -c, c}, {c, -c, c}, {-c, c, -c}, {c, c, -c}, {-c, c, c}, {c, c, c}}};
  return directions;
}

#define SUNFLECK_INSTANTIATE(Real)                                                                      \
  template Real lobe_function(Real);                                                                    \
  template Real mean_decay(Real);                                                                       \
  template AnglePair<Real> angle_between(const Direction<Real>&, const Direction<Real>&);               \
  template Real mean_transmitting_cosines(const AnglePair<Real>&);                                      \
  template Real mean_reflecting_cosines(const AnglePair<Real>&);                                        \
  template Real scattering_lobe(const LeafSums<Real>&, const AnglePair<Real>&);                         \
  template Real scattering_density(Real, int, const LeafSums<Real>&, const AnglePair<Real>&);           \
  template Real interpolation_weights(std::span<const Direction<Real>>, const Direction<Real>&,         \
                                      std::span<Real>);                                                 \
  template Real approach_towards(std::span<const Direction<Real>>, std::span<const Real>, std::size_t); \
  template Real interpolated(std::span<const Real>, std::span<const Real>);                             \
  template Real published_sector_sample(const PublishedSector<Real>&);                                  \
  template Real one_bounce_integral(Real, Real, Real);                                                  \
  template Real one_bounce_sector(Real, Real, Real, Real);                                              \
  template const std::array<Direction<Real>, 8>& cube_directions<Real>();

SUNFLECK_INSTANTIATE(double)
SUNFLECK_INSTANTIATE(float)
#undef SUNFLECK_INSTANTIATE

}  // namespace sunfleck::envelope
