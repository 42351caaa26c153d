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

std::vector<double> sums_of_squares(const ParameterNet& net, const std::vector<double>& measured) {
  std::vector<double> sums;
  for (const std::vector<double>& light : net.light) {
    double sum = 0;
    for (std::size_t s = 0; s < measured.size(); ++s) sum += std::pow(light[s] - measured[s], 2);
    sums.push_back(sum);
  }
  return sums;
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

// Squared errors of one split: fitted on the sensors of `half`, told for the others.
double told_error(const std::vector<std::vector<double>>& squares, const std::vector<bool>& half) {
  double best = std::numeric_limits<double>::infinity(), told = 0;
  for (const std::vector<double>& at_place : squares) {
    double inside = 0, outside = 0;
    for (std::size_t s = 0; s < half.size(); ++s) (half[s] ? inside : outside) += at_place[s];
    if (inside < best) best = inside, told = outside;
  }
  const auto others = std::count(half.begin(), half.end(), false);
  return std::sqrt(told / static_cast<double>(others));
}

// All places of the net; with two parameters every fourth step of the first (6 %).
std::vector<std::vector<double>> squared_errors(const ParameterNet& net,
                                                const std::vector<double>& measured) {
  const std::size_t stride = net.axis.size() == 2 ? 4 : 1;
  std::vector<std::vector<double>> squares;
  for (std::size_t p = 0; p < net.size(); ++p) {
    if (net.step_of(p, 0) % stride != 0) continue;
    squares.emplace_back();
    for (std::size_t s = 0; s < measured.size(); ++s)
      squares.back().push_back(std::pow(net.light[p][s] - measured[s], 2));
  }
  return squares;
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
                                                const std::vector<double>& measured, double confidence) {
  const std::size_t p = emulator.axes.size(), n = measured.size();
  SUNFLECK_EXPECTS(emulator.sensors() == n && n > p);
  const ParameterNet net(emulator);
  const std::vector<double> sums = sums_of_squares(net, measured);
  const auto best = static_cast<std::size_t>(std::min_element(sums.begin(), sums.end()) - sums.begin());
  const double t = student_t(confidence, static_cast<int>(n - p));
  const double limit = sums[best] * (1 + t * t / static_cast<double>(n - p));
  std::vector<CalibratedParameter> parameters;
  for (std::size_t axis = 0; axis < p; ++axis) parameters.push_back(estimate(net, sums, best, limit, axis));
  return parameters;
}

SplitHalf split_half(const LightEmulator& emulator, const std::vector<double>& measured) {
  const std::size_t n = measured.size();
  SUNFLECK_EXPECTS(emulator.sensors() == n && n >= 2);
  const auto squares = squared_errors(ParameterNet(emulator), measured);
  std::vector<bool> half(n, false);
  std::fill(half.begin() + static_cast<std::ptrdiff_t>(n - n / 2), half.end(), true);
  double sum = 0, sum2 = 0;
  SplitHalf answer;
  for (bool more = true; more;) {
    const double error = told_error(squares, half);
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
