#include "lighting/plan/auto_probe.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/base/contract.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

using Chosen = std::span<const std::uint32_t>;

// The true mean from the estimate's: never so small that nothing can be relative to it.
double true_mean(double estimated_mean, double mean_difference) {
  return std::max(estimated_mean - mean_difference, 1e-3 * estimated_mean);
}

// b / (M - b) with b the area-weighted mean difference and M the estimate's mean; standard error by the first
// derivatives.
Figure bias_of(const ErrorSample& s, Chosen chosen) {
  if (!(s.area_mean_w_m2 > 0.0)) return {};
  const auto n = static_cast<double>(chosen.size());
  double area = 0.0, sum = 0.0, squares = 0.0;
  for (const std::uint32_t i : chosen) {
    area += s.area_m2[i];
    sum += s.area_m2[i] * s.difference_w_m2[i];
  }
  const double b = area > 0.0 ? sum / area : 0.0;
  for (const std::uint32_t i : chosen) {
    const double pull = s.area_m2[i] * (s.difference_w_m2[i] - b);
    squares += pull * pull;
  }
  const double error = area > 0.0 ? std::sqrt(squares * n / (n - 1.0)) / area : 0.0;
  const double mean = true_mean(s.area_mean_w_m2, b);
  return {b / mean, error * s.area_mean_w_m2 / (mean * mean)};
}

// m / (M - d)^2 with m the mean of difference^2 - variance, d the mean difference.
Figure square_of(const ErrorSample& s, Chosen chosen) {
  if (!(s.mean_w_m2 > 0.0)) return {};
  const auto n = static_cast<double>(chosen.size());
  const auto square = [&](std::uint32_t i) {
    return s.difference_w_m2[i] * s.difference_w_m2[i] - s.variance_w2_m4[i];
  };
  double m = 0.0, d = 0.0, pulls = 0.0;
  for (const std::uint32_t i : chosen) {
    m += square(i) / n;
    d += s.difference_w_m2[i] / n;
  }
  const double mean = true_mean(s.mean_w_m2, d);
  for (const std::uint32_t i : chosen) {
    const double pull = square(i) - m + 2.0 * m * (s.difference_w_m2[i] - d) / mean;
    pulls += pull * pull;
  }
  return {m / (mean * mean), std::sqrt(pulls / (n * (n - 1.0))) / (mean * mean)};
}

double root(double x) { return std::sqrt(std::max(0.0, x)); }

std::vector<std::uint32_t> all_of(const ErrorSample& s) {
  std::vector<std::uint32_t> all(s.difference_w_m2.size());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

}  // namespace

LightParts parts_of(const ElementLight& e, double sunlit_fraction, double close_cover) {
  const auto sum = [](float a, float b) { return static_cast<double>(a) + b; };
  return {sum(e.front.direct_w_m2, e.back.direct_w_m2), sum(e.front.sky_w_m2, e.back.sky_w_m2),
          sum(e.front.scattered_w_m2, e.back.scattered_w_m2), sunlit_fraction, close_cover};
}

LightParts parts_of(const ProbeBand& p) {
  return {p.front.direct_w_m2 + p.back.direct_w_m2, p.front.sky_w_m2 + p.back.sky_w_m2,
          p.front.scattered_w_m2 + p.back.scattered_w_m2};
}

ProbeSet draw_probes(const ProbeScene& scene, const OpticsTable& optics, const Illumination& light,
                     const ProbePlan& plan, const RunControl& control) {
  check_options(plan);
  const std::size_t elements = scene.receivers().foliage_count();
  SUNFLECK_EXPECTS(elements > 0);
  RandomStream random(plan.seed, 0, RandomPurpose::kProbeDraw);
  std::vector<std::size_t> drawn(static_cast<std::size_t>(plan.count));
  ProbeSet set;
  for (std::size_t& e : drawn) {
    e = random.below(static_cast<std::uint32_t>(elements));  // Receivers holds fewer than 2^32
    set.area_m2.push_back(scene.receivers().area_m2(e));
  }
  set.probes =
      probe_light(scene, optics, light, drawn, {plan.seed, plan.paths_per_face, plan.sun_rays}, control);
  return set;
}

ErrorSample sample_error(const ProbeSet& probes, const std::vector<LightParts>& estimate,
                         const BandLightMap& map, std::size_t band) {
  SUNFLECK_EXPECTS(estimate.size() == probes.probes.size());
  ErrorSample s;
  s.area_m2 = probes.area_m2;
  s.mean_w_m2 = mean_total_w_m2(map);
  s.area_mean_w_m2 = map.mean_irradiance_w_m2;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const ProbeBand& truth = probes.probes[i].bands[band];
    s.difference_w_m2.push_back(estimate[i].total() - truth.irradiance_w_m2());
    s.variance_w2_m4.push_back(truth.variance_w2_m4());
  }
  return s;
}

ErrorSample sample_error(const ProbeSet& probes, const BandLightMap& map, std::size_t band) {
  std::vector<LightParts> estimate;
  for (const ProbeLight& p : probes.probes) estimate.push_back(parts_of(map.elements[p.element]));
  return sample_error(probes, estimate, map, band);
}

ErrorBar error_bar(const ErrorSample& sample, const Resamples& resamples) {
  SUNFLECK_EXPECTS(resamples.probes() == sample.difference_w_m2.size());
  ErrorBar bar;
  bar.bias = resamples.interval([&](Chosen chosen) { return bias_of(sample, chosen); });
  const Interval squares = resamples.interval([&](Chosen chosen) { return square_of(sample, chosen); });
  bar.element_rms = {root(squares.value), root(squares.low), root(squares.high)};
  const double mean = sample.area_mean_w_m2 / (1.0 + bar.bias.value);
  bar.mean_standard_error_w_m2 =
      mean * std::hypot(bar.bias.value, (bar.bias.high - bar.bias.low) / (2 * 1.96));
  return bar;
}

PointError point_error(const ErrorSample& sample) {
  const std::vector<std::uint32_t> all = all_of(sample);
  const Figure square = square_of(sample, all);
  return {bias_of(sample, all), root(square.value), root(1.96 * square.standard_error)};
}

double mean_total_w_m2(const BandLightMap& map) {
  double sum = 0.0;
  for (const ElementLight& e : map.elements) sum += parts_of(e).total();
  return map.elements.empty() ? 0.0 : sum / static_cast<double>(map.elements.size());
}

}  // namespace sunfleck
