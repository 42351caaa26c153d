#include "lighting/render/image_difference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "lighting/render/flip.h"
#include "sim/base/contract.h"

namespace sunfleck {
namespace {

constexpr int kWindow = 11;
constexpr double kSigma = 1.5, kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;

std::array<double, kWindow> gaussian() {
  std::array<double, kWindow> g;
  for (int i = 0; i < kWindow; ++i)
    g[static_cast<std::size_t>(i)] = std::exp(-std::pow((i - kWindow / 2) / kSigma, 2) / 2.0);
  const double sum = std::accumulate(g.begin(), g.end(), 0.0);
  for (double& x : g) x /= sum;
  return g;
}

// Weighted means over all windows that lie inside, by rows, then columns.
std::vector<double> filtered(const std::vector<double>& v, int width, int height) {
  static const std::array<double, kWindow> g = gaussian();
  const int inner_width = width - kWindow + 1, inner_height = height - kWindow + 1;
  const auto at = [](int x, int y, int stride) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(stride) + static_cast<std::size_t>(x);
  };
  std::vector<double> rows(at(0, height, inner_width)), result(at(0, inner_height, inner_width));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < inner_width; ++x)
      for (int k = 0; k < kWindow; ++k)
        rows[at(x, y, inner_width)] += g[static_cast<std::size_t>(k)] * v[at(x + k, y, width)];
  for (int y = 0; y < inner_height; ++y)
    for (int x = 0; x < inner_width; ++x)
      for (int k = 0; k < kWindow; ++k)
        result[at(x, y, inner_width)] += g[static_cast<std::size_t>(k)] * rows[at(x, y + k, inner_width)];
  return result;
}

std::vector<double> product(std::span<const double> a, std::span<const double> b) {
  std::vector<double> p(a.size());
  std::transform(a.begin(), a.end(), b.begin(), p.begin(), std::multiplies<>());
  return p;
}

double brightest(const Image& image, std::size_t p) {
  return std::max({image.rgb[3 * p], image.rgb[3 * p + 1], image.rgb[3 * p + 2]});
}

std::vector<double> shown_grey(const Image& image, double white) {
  std::vector<double> grey(image.rgb.size() / 3);
  for (std::size_t p = 0; p < grey.size(); ++p) {
    const float* rgb = &image.rgb[3 * p];
    const double x = std::clamp((0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]) / white, 0.0, 1.0);
    grey[p] = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
  }
  return grey;
}

std::vector<double> shown_colours(const Image& image, double white) {
  std::vector<double> colours(image.rgb.begin(), image.rgb.end());
  for (double& c : colours) c /= white;
  return colours;
}

}  // namespace

double structural_similarity(std::span<const double> a, std::span<const double> b, int width_px,
                             int height_px) {
  SUNFLECK_EXPECTS(a.size() == b.size() && width_px >= kWindow && height_px >= kWindow);
  const auto mean_a = filtered({a.begin(), a.end()}, width_px, height_px);
  const auto mean_b = filtered({b.begin(), b.end()}, width_px, height_px);
  const auto aa = filtered(product(a, a), width_px, height_px);
  const auto bb = filtered(product(b, b), width_px, height_px);
  const auto ab = filtered(product(a, b), width_px, height_px);
  double sum = 0.0;
  for (std::size_t i = 0; i < ab.size(); ++i) {
    const double ma = mean_a[i], mb = mean_b[i];
    sum += (2 * ma * mb + kC1) * (2 * (ab[i] - ma * mb) + kC2) /
           ((ma * ma + mb * mb + kC1) * (aa[i] - ma * ma + bb[i] - mb * mb + kC2));
  }
  return sum / static_cast<double>(ab.size());
}

ImageDifference image_difference(const Image& a, const Image& b) {
  SUNFLECK_EXPECTS(a.width_px == b.width_px && a.height_px == b.height_px);
  std::vector<std::size_t> order(b.rgb.size() / 3);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::size_t kept = order.size() - order.size() / 100;
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(kept - 1), order.end(),
                   [&](std::size_t p, std::size_t q) { return brightest(b, p) < brightest(b, q); });
  double sum_a = 0.0, sum_b = 0.0, apart = 0.0, white = 0.0;
  for (std::size_t i = 0; i < kept; ++i)
    for (std::size_t c = 3 * order[i]; c < 3 * order[i] + 3; ++c) {
      sum_a += a.rgb[c], sum_b += b.rgb[c];
      apart += std::abs(static_cast<double>(a.rgb[c]) - b.rgb[c]);
      white = std::max(white, static_cast<double>(b.rgb[c]));
    }
  ImageDifference d;
  if (sum_b > 0.0) d.bias = sum_a / sum_b - 1.0, d.mean_absolute = apart / sum_b;
  if (white > 0.0 && std::min(a.width_px, a.height_px) >= kWindow)
    d.ssim = structural_similarity(shown_grey(a, white), shown_grey(b, white), a.width_px, a.height_px);
  if (white > 0.0)
    d.flip = flip_difference(shown_colours(a, white), shown_colours(b, white), a.width_px, a.height_px).mean;
  return d;
}

}  // namespace sunfleck
