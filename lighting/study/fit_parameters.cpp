// Least squares on the net, profile intervals and the test on other halves. See calibrate.h.
#include <algorithm>
#include <cmath>
#include <limits>

#include "lighting/study/calibrate.h"
#include "lighting/study/parameter_net.h"
#include "sim/base/contract.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

constexpr std::size_t kMostForAllSplits = 20, kDrawnSplits = 10000;

// What a set of sensors says at one place of the net: with L the mean of the light there, sums of products of
// r = measured - L and x = light - L.
struct Moments {
  double rr = 0, rx = 0, xx = 0;
  void operator+=(const Moments& o) { rr += o.rr, rx += o.rx, xx += o.xx; }
  double squares(double share) const { return rr - 2 * share * rx + share * share * xx; }
};

// [place][sensor]
using PlaceMoments = std::vector<std::vector<Moments>>;

// Every `stride`-th step of the first axis.
PlaceMoments moments_of(const ParameterNet& net, const std::vector<double>& measured, std::size_t stride) {
  PlaceMoments all;
  for (std::size_t p = 0; p < net.size(); ++p) {
    if (net.step_of(p, 0) % stride != 0) continue;
    double mean = 0;
    for (const double light : net.light[p]) mean += light / static_cast<double>(measured.size());
    all.emplace_back();
    for (std::size_t s = 0; s < measured.size(); ++s) {
      const double r = measured[s] - mean, x = net.light[p][s] - mean;
      all.back().push_back({r * r, r * x, x * x});
    }
  }
  return all;
}

Moments sum_of(const std::vector<Moments>& of_sensors) {
  Moments sum;
  for (const Moments& m : of_sensors) sum += m;
  return sum;
}

std::vector<Moments> sums_of(const PlaceMoments& places) {
  std::vector<Moments> sums;
  for (const auto& place : places) sums.push_back(sum_of(place));
  return sums;
}

// The share of the pattern that fits best and what it costs: squares and, with a prior, its penalty.
struct Share {
  double value = 1, cost = 0;
};
Share best_share(const Moments& m, double penalty, bool damping) {
  if (!damping || !(m.xx + penalty > 0)) return {1, m.squares(1)};
  const double share = std::max(0.0, (m.rx + penalty) / (m.xx + penalty));
  return {share, std::max(0.0, m.squares(share)) + penalty * (share - 1) * (share - 1)};
}

// Weight of the prior against squares: variance that the unpenalised fit leaves, over the prior's.
double penalty_of(const std::vector<Moments>& places, std::size_t sensors, std::size_t parameters,
                  const FitOptions& o) {
  if (!o.damping) return 0;
  double least = std::numeric_limits<double>::infinity();
  for (const Moments& m : places) least = std::min(least, best_share(m, 0, true).cost);
  return least / static_cast<double>(sensors - parameters) / (o.damping_prior_sd * o.damping_prior_sd);
}

// Least sum for each step of an axis, over the other axis.
std::vector<double> profile(const ParameterNet& net, const std::vector<double>& sums, std::size_t axis) {
  std::vector<double> least(net.axis[axis].size(), std::numeric_limits<double>::infinity());
  for (std::size_t p = 0; p < net.size(); ++p) {
    double& here = least[net.step_of(p, axis)];
    here = std::min(here, sums[p]);
  }
  return least;
}

// Where the profile crosses `limit`, going from `best` by `step`; open if it never does.
std::pair<double, bool> crossing(const std::vector<double>& axis, const std::vector<double>& least,
                                 double limit, std::size_t best, long step) {
  auto i = static_cast<long>(best);
  const auto end = static_cast<long>(axis.size());
  while (i + step >= 0 && i + step < end && least[static_cast<std::size_t>(i + step)] <= limit) i += step;
  const auto in = static_cast<std::size_t>(i);
  if (i + step < 0 || i + step >= end) return {axis[in], true};
  const auto out = static_cast<std::size_t>(i + step);
  const double part = (limit - least[in]) / (least[out] - least[in]);
  return {axis[in] + part * (axis[out] - axis[in]), false};
}

double factor_of(double place, std::size_t axis) { return axis == 0 ? std::exp(place) : std::expm1(place); }

CalibratedParameter estimate(const ParameterNet& net, const std::vector<double>& sums, std::size_t best,
                             double limit, std::size_t axis) {
  const std::vector<double> least = profile(net, sums, axis);
  const std::vector<double>& places = net.axis[axis];
  const std::size_t step = net.step_of(best, axis);
  const auto [low, low_open] = crossing(places, least, limit, step, -1);
  const auto [high, high_open] = crossing(places, least, limit, step, 1);
  CalibratedParameter p{axis == 0 ? "leaf_area_factor" : "understorey_stems_factor",
                        factor_of(places[step], axis), factor_of(low, axis), factor_of(high, axis)};
  const bool none_is_least = axis == 1 && step == 0;  // no stems at all is an answer, not an edge
  p.low_open = low_open && axis == 0;
  p.high_open = high_open;
  p.at_edge = (step == 0 && !none_is_least) || step + 1 == places.size();
  return p;
}

// The share's own interval: at each place the cost is a parabola in it.
CalibratedParameter share_estimate(const std::vector<Moments>& places, double penalty, std::size_t best,
                                   double limit) {
  CalibratedParameter p{"pattern_share", best_share(places[best], penalty, true).value};
  p.low = p.high = p.value;
  for (const Moments& m : places) {
    const Share here = best_share(m, penalty, true);
    if (here.cost > limit || !(m.xx + penalty > 0)) continue;
    const double reach = std::sqrt((limit - here.cost) / (m.xx + penalty));
    p.low = std::max(0.0, std::min(p.low, here.value - reach));
    p.high = std::max(p.high, here.value + reach);
  }
  p.at_edge = p.value == 0;
  return p;
}

// Error of one split: fitted on the sensors of `half`, told for the others.
double told_error(const PlaceMoments& places, const std::vector<bool>& half, std::size_t parameters,
                  const FitOptions& o) {
  std::vector<Moments> inside(places.size()), outside(places.size());
  for (std::size_t p = 0; p < places.size(); ++p)
    for (std::size_t s = 0; s < half.size(); ++s) (half[s] ? inside[p] : outside[p]) += places[p][s];
  const auto others = static_cast<std::size_t>(std::count(half.begin(), half.end(), false));
  const double penalty = penalty_of(inside, half.size() - others, parameters, o);
  double least = std::numeric_limits<double>::infinity(), told = 0;
  for (std::size_t p = 0; p < places.size(); ++p) {
    const Share share = best_share(inside[p], penalty, o.damping);
    if (share.cost < least) least = share.cost, told = outside[p].squares(share.value);
  }
  return std::sqrt(std::max(0.0, told) / static_cast<double>(others));
}

void shuffle(std::vector<bool>& half, std::uint64_t split) {
  RandomStream random(1, split, RandomPurpose::kSplitHalf);
  for (std::size_t i = half.size(); i > 1; --i) {
    const std::size_t j = random.below(static_cast<std::uint32_t>(i));
    const bool kept = half[i - 1];
    half[i - 1] = half[j];
    half[j] = kept;
  }
}

}  // namespace

std::vector<CalibratedParameter> fit_parameters(const LightEmulator& emulator,
                                                const std::vector<double>& measured, const FitOptions& o) {
  const std::size_t axes = emulator.axes.size(), p = axes + (o.damping ? 1 : 0), n = measured.size();
  SUNFLECK_EXPECTS(emulator.sensors() == n && n > p);
  const ParameterNet net(emulator);
  const std::vector<Moments> places = sums_of(moments_of(net, measured, 1));
  const double penalty = penalty_of(places, n, p, o);
  std::vector<double> costs;
  for (const Moments& m : places) costs.push_back(best_share(m, penalty, o.damping).cost);
  const auto best = static_cast<std::size_t>(std::min_element(costs.begin(), costs.end()) - costs.begin());
  const double t = student_t(o.confidence, static_cast<int>(n - p));
  const double limit = costs[best] * (1 + t * t / static_cast<double>(n - p));
  std::vector<CalibratedParameter> parameters;
  for (std::size_t axis = 0; axis < axes; ++axis)
    parameters.push_back(estimate(net, costs, best, limit, axis));
  if (o.damping) parameters.push_back(share_estimate(places, penalty, best, limit));
  return parameters;
}

SplitHalf split_half(const LightEmulator& emulator, const std::vector<double>& measured,
                     const FitOptions& o) {
  const std::size_t n = measured.size(), parameters = emulator.axes.size() + (o.damping ? 1 : 0);
  SUNFLECK_EXPECTS(emulator.sensors() == n && n >= 2);
  SplitHalf answer;
  if (n / 2 <= parameters) return answer;
  const PlaceMoments places = moments_of(ParameterNet(emulator), measured, emulator.axes.size() == 2 ? 4 : 1);
  std::vector<bool> half(n, false);
  std::fill(half.begin() + static_cast<std::ptrdiff_t>(n - n / 2), half.end(), true);
  double sum = 0, sum2 = 0;
  for (bool more = true; more;) {
    const double error = told_error(places, half, parameters, o);
    sum += error, sum2 += error * error;
    ++answer.splits;
    if (n <= kMostForAllSplits)
      more = std::next_permutation(half.begin(), half.end());
    else
      shuffle(half, answer.splits), more = answer.splits < kDrawnSplits;
  }
  const auto count = static_cast<double>(answer.splits);
  answer.rmse = sum / count;
  answer.spread = std::sqrt(std::max(0.0, sum2 / count - answer.rmse * answer.rmse));
  return answer;
}

}  // namespace sunfleck
