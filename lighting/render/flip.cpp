#include "lighting/render/flip.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "lighting/render/flip_colour.h"
#include "sim/base/contract.h"

namespace sunfleck {
namespace {

// Section 4.3 and appendix: exponents, and the part of the range of differences below which .95 is used up.
constexpr double kColourPower = 0.7, kKnee = 0.4, kKneeValue = 0.95, kFeaturePower = 0.5;
constexpr double kFeatureWidthDeg = 0.082;  // of an edge's bar as the eye detects it best

struct Plane {
  int width = 0, height = 0;
  std::vector<double> value;
  double at(int x, int y) const {
    return value[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

// A filter along one axis, from -radius to radius.
using Taps = std::vector<double>;

// Along x and y; pixels outside are those of the rim.
Plane filtered(const Plane& in, const Taps& along_x, const Taps& along_y) {
  const int rx = static_cast<int>(along_x.size()) / 2, ry = static_cast<int>(along_y.size()) / 2;
  Plane rows{in.width, in.height, std::vector<double>(in.value.size())}, out = rows;
  std::size_t at = 0;
  for (int y = 0; y < in.height; ++y)
    for (int x = 0; x < in.width; ++x, ++at)
      for (int k = -rx; k <= rx; ++k)
        rows.value[at] +=
            along_x[static_cast<std::size_t>(k + rx)] * in.at(std::clamp(x + k, 0, in.width - 1), y);
  at = 0;
  for (int y = 0; y < in.height; ++y)
    for (int x = 0; x < in.width; ++x, ++at)
      for (int k = -ry; k <= ry; ++k)
        out.value[at] +=
            along_y[static_cast<std::size_t>(k + ry)] * rows.at(x, std::clamp(y + k, 0, in.height - 1));
  return out;
}

template <class F>
Taps taps(int radius, const F& f) {
  Taps t;
  for (int k = -radius; k <= radius; ++k) t.push_back(f(static_cast<double>(k)));
  return t;
}

double sum(const Taps& t) { return std::accumulate(t.begin(), t.end(), 0.0); }

// Contrast sensitivity (their table 1): a exp(-b f^2) over frequency f in cycles per degree is the Gaussian
// a sqrt(pi / b) exp(-pi^2 x^2 / b) over angle x in degrees; two of them for blue against yellow.
struct Sensitivity {
  std::array<double, 2> a, b;
};
constexpr std::array<Sensitivity, 3> kSensitivity{{{{1, 0}, {0.0047, 1e-5}},  // light against dark
                                                   {{1, 0}, {0.0053, 1e-5}},  // red against green
                                                   {{34.1, 13.5}, {0.04, 0.025}}}};

Plane seen(const Plane& in, const Sensitivity& s, double pixels_per_degree) {
  constexpr double pi2 = kPi * kPi;
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi2)) * pixels_per_degree));
  Plane all{in.width, in.height, std::vector<double>(in.value.size())};
  double total = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    if (s.a[i] == 0) continue;
    const double strength = s.a[i] * std::sqrt(kPi / s.b[i]);
    const Taps g = taps(radius, [&](double x) {
      return std::exp(-pi2 * x * x / (s.b[i] * pixels_per_degree * pixels_per_degree));
    });
    const Plane part = filtered(in, g, g);
    for (std::size_t p = 0; p < all.value.size(); ++p) all.value[p] += strength * part.value[p];
    total += strength * sum(g) * sum(g);
  }
  for (double& v : all.value) v /= total;
  return all;
}

using Opponent = std::array<Plane, 3>;

Opponent opponent_of(std::span<const double> rgb, int width, int height) {
  Opponent planes;
  for (Plane& p : planes) p = {width, height, std::vector<double>(rgb.size() / 3)};
  for (std::size_t p = 0; p < rgb.size() / 3; ++p) {
    const Vec3 c = glm::clamp(Vec3(rgb[3 * p], rgb[3 * p + 1], rgb[3 * p + 2]), Vec3(0), Vec3(1));
    const Vec3 o = opponent_from_rgb(c);
    for (int k = 0; k < 3; ++k) planes[static_cast<std::size_t>(k)].value[p] = o[k];
  }
  return planes;
}

// Lab of each pixel as the eye resolves it.
std::vector<Vec3> resolved(const Opponent& planes, double pixels_per_degree) {
  Opponent blurred;
  for (std::size_t k = 0; k < 3; ++k) blurred[k] = seen(planes[k], kSensitivity[k], pixels_per_degree);
  std::vector<Vec3> lab(blurred[0].value.size());
  for (std::size_t p = 0; p < lab.size(); ++p) {
    const Vec3 o(blurred[0].value[p], blurred[1].value[p], blurred[2].value[p]);
    lab[p] = hunt_lab_from_rgb(glm::clamp(rgb_from_opponent(o), Vec3(0), Vec3(1)));
  }
  return lab;
}

// HyAB to the power .7, compressed: the largest (green against blue) is 1.
double colour_difference(const Vec3& a, const Vec3& b) {
  static const double largest =
      std::pow(hyab(hunt_lab_from_rgb({0, 1, 0}), hunt_lab_from_rgb({0, 0, 1})), kColourPower);
  const double d = std::pow(hyab(a, b), kColourPower), knee = kKnee * largest;
  return d < knee ? kKneeValue / knee * d : kKneeValue + (d - knee) / (largest - knee) * (1 - kKneeValue);
}

// Positive taps sum to 1 and negative ones to -1.
void balance(Taps& t) {
  double positive = 0, negative = 0;
  for (const double v : t) (v > 0 ? positive : negative) += v;
  for (double& v : t) v /= v > 0 ? positive : -negative;
}

// Strength of a feature everywhere: first (edges) or second (points) derivative of a Gaussian along x and y.
std::vector<double> features(const Plane& light, bool points, double pixels_per_degree) {
  const double s = 0.5 * kFeatureWidthDeg * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * s));
  Taps g = taps(radius, [&](double x) { return std::exp(-x * x / (2 * s * s)); });
  Taps d = taps(radius, [&](double x) {
    const double gauss = std::exp(-x * x / (2 * s * s));
    return points ? (x * x / (s * s) - 1) * gauss : -x * gauss;
  });
  const double total = sum(g);
  for (double& v : g) v /= total;
  balance(d);
  const Plane x = filtered(light, d, g), y = filtered(light, g, d);
  std::vector<double> strength(x.value.size());
  for (std::size_t p = 0; p < strength.size(); ++p) strength[p] = std::hypot(x.value[p], y.value[p]);
  return strength;
}

std::vector<double> feature_differences(const Plane& a, const Plane& b, double pixels_per_degree) {
  const auto brightness = [](Plane p) {
    for (double& v : p.value) v = (v + 16) / 116;
    return p;
  };
  const Plane ya = brightness(a), yb = brightness(b);
  std::vector<double> difference(a.value.size());
  for (const bool points : {false, true}) {
    const auto fa = features(ya, points, pixels_per_degree), fb = features(yb, points, pixels_per_degree);
    for (std::size_t p = 0; p < difference.size(); ++p)
      difference[p] = std::max(difference[p], std::abs(fa[p] - fb[p]));
  }
  for (double& d : difference) d = std::pow(d / std::sqrt(2.0), kFeaturePower);
  return difference;
}

void pool(FlipDifference& flip) {
  std::vector<float> sorted = flip.map;
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  double total = 0;
  for (const float v : sorted) total += v;
  flip.mean = total / static_cast<double>(sorted.size());
  flip.largest = sorted.front();
  double running = 0;
  for (const float v : sorted) {
    running += v;
    flip.weighted_median = v;
    if (running >= 0.5 * total) break;
  }
}

}  // namespace

FlipDifference flip_difference(std::span<const double> a, std::span<const double> b, int width_px,
                               int height_px, const FlipOptions& options) {
  SUNFLECK_EXPECTS(width_px > 0 && height_px > 0 && a.size() == b.size());
  SUNFLECK_EXPECTS(a.size() == 3 * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
  SUNFLECK_EXPECTS(options.pixels_per_degree >= 1 && options.pixels_per_degree <= 1000);
  const Opponent pa = opponent_of(a, width_px, height_px), pb = opponent_of(b, width_px, height_px);
  const auto la = resolved(pa, options.pixels_per_degree), lb = resolved(pb, options.pixels_per_degree);
  const auto feature = feature_differences(pa[0], pb[0], options.pixels_per_degree);
  FlipDifference flip;
  for (std::size_t p = 0; p < la.size(); ++p) {
    const double colour = std::clamp(colour_difference(la[p], lb[p]), 0.0, 1.0);
    flip.map.push_back(static_cast<float>(std::pow(colour, 1 - std::min(1.0, feature[p]))));
  }
  pool(flip);
  return flip;
}

}  // namespace sunfleck
