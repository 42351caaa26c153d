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

// Leaves of few pixels are mostly wholly in the sun or in shade: their outcomes scatter by this part of what
// coins of the same mean do; measured likewise.
constexpr double kOfFewPixels = 0.6;

SunlitEstimate of_look_up(double looked_up) {
  return {looked_up < 0.0 ? 0.5 : looked_up, kOfFewPixels * 0.1875};
}

}  // namespace

double rim_seen_m(const FoliageElement& leaf, const Vec3& to_sun) {
  const auto across = [&](const Vec3& v) { return v - glm::dot(v, to_sun) * to_sun; };
  const Vec3 a = across(Vec3(leaf.half_u_m)), b = across(Vec3(leaf.half_v_m));
  if (leaf.shape == ElementShape::kDisc) return kPi * std::sqrt(2.0 * (glm::dot(a, a) + glm::dot(b, b)));
  if (leaf.shape == ElementShape::kTriangle) return glm::length(a) + glm::length(b) + glm::length(a - b);
  return 4.0 * (glm::length(a) + glm::length(b));
}

SunlitEstimate sunlit_leaf(const SunTally& tally, double rim_pixels, double looked_up) {
  if (tally.covered == 0) return of_look_up(looked_up);
  const double count = static_cast<double>(tally.covered) / kWhole;
  const double seen = static_cast<double>(tally.visible) / kWhole;
  const double changes = static_cast<double>(tally.borders) / kWhole;
  const double part = smoothed(seen, count), binomial = part * (1.0 - part);
  // The element's rim counts to the lit and to the whole area: what is left of it in their ratio.
  const double rim = rim_pixels * binomial;
  // Spots and notches between pixels escape the count: of the variance a part that falls with the leaf's side
  // in pixels; measured on the crowns of the tests.
  const double missed = 1.12 + 1.6 / std::sqrt(count);
  const double variance = kPerBorder * missed * (kBorderPerChange * changes + rim) / (count * count);
  return {seen / count, std::min(variance, kOfFewPixels * binomial)};
}

SunlitEstimate sunlit_shoot(const SunTally& tally, double looked_up) {
  if (tally.covered == 0) return of_look_up(looked_up);
  const double way = static_cast<double>(tally.covered) / kWhole;
  const double mean = static_cast<double>(tally.visible) / static_cast<double>(tally.covered);
  const double squares = static_cast<double>(tally.borders) / static_cast<double>(tally.covered);
  // As for borders of shade, h^3: the spread over the pixels falls by way^1.5 instead of as random points
  // would; few pixels know little of their spread. Factors measured on a grown spruce.
  const double spread = std::max(0.0, squares - mean * mean) + 0.02 / (1.0 + way);
  const double gain = std::min(1.0, 0.14 * (1.0 + 5.0 / (1.0 + way)) / std::sqrt(1.0 + way));
  return {std::min(1.0, mean), std::min(0.25, gain * spread / (1.0 + way))};
}

SunlitEstimate SunlitMean::mean(int pictures) const {
  const double n = pictures, fraction = sum_ / n, of_pictures = variances_ / n;
  double beyond = 0.0;
  if (pictures > 1) beyond = std::max(0.0, (squares_ - sum_ * fraction) / (n - 1.0) - of_pictures);
  return {std::clamp(fraction, 0.0, 1.0), (of_pictures + beyond) / n};
}

}  // namespace sunfleck::trace
