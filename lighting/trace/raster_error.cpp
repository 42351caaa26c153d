#include "lighting/trace/raster_error.h"

#include <algorithm>
#include <cmath>

namespace sunfleck::trace {
namespace {

// Variance of an area counted on a square grid of side 1 at random, per length of its border; Kendall and
// Moran 1963, "Geometrical probability"; Matheron 1971, "The theory of regionalized variables".
constexpr double kPerBorder = 0.0724;
// A border of length B at any angle changes the value between about 4 / pi B pairs of neighbours.
constexpr double kBorderPerChange = 0.785398;

// Of a fraction of `count` pixels, no run of equal outcomes claiming certainty (Jeffreys' prior).
double smoothed(double seen, double count) { return (seen + 0.5) / (count + 1.0); }

SunlitEstimate of_look_up(double looked_up) {
  return {looked_up < 0.0 ? 0.5 : looked_up, 0.1875};  // 1/4 * 3/4: one outcome after Jeffreys
}

}  // namespace

SunlitEstimate sunlit_leaf(const SunTally& tally, double looked_up) {
  if (tally.covered == 0) return of_look_up(looked_up);
  const double count = static_cast<double>(tally.covered) / kWhole;
  const double seen = static_cast<double>(tally.visible) / kWhole;
  const double changes = static_cast<double>(tally.borders) / kWhole;
  const double part = smoothed(seen, count), binomial = part * (1.0 - part);
  // The element's rim counts to the lit and to the whole area: what is left of it in their ratio.
  constexpr double kRimOfSquare = 4.5;  // of a parallelogram of that area, somewhat slanted
  const double rim = kRimOfSquare * std::sqrt(count) * binomial;
  const double variance = kPerBorder * (kBorderPerChange * changes + rim) / (count * count);
  return {seen / count, std::min(variance, binomial)};
}

SunlitEstimate sunlit_shoot(const SunTally& tally, double looked_up) {
  if (tally.covered == 0) return of_look_up(looked_up);
  const double way = static_cast<double>(tally.covered) / kWhole;
  const double mean = static_cast<double>(tally.visible) / static_cast<double>(tally.covered);
  const double squares = static_cast<double>(tally.borders) / static_cast<double>(tally.covered);
  const double spread = std::max(0.0, squares - mean * mean);
  return {std::min(1.0, mean), std::min(0.25, spread / (1.0 + way))};
}

SunlitEstimate SunlitMean::mean(int pictures) const {
  const double n = pictures, fraction = sum_ / n, of_pictures = variances_ / n;
  double beyond = 0.0;
  if (pictures > 1) beyond = std::max(0.0, (squares_ - sum_ * fraction) / (n - 1.0) - of_pictures);
  return {std::clamp(fraction, 0.0, 1.0), (of_pictures + beyond) / n};
}

}  // namespace sunfleck::trace
