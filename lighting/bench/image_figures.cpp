// With halves A and B of independent samples the mean R = (A + B) / 2 has the variance E[(A - B)^2] / 4, so
// that E[(I - R)^2] - E[((A - B) / 2)^2] is the squared error of a picture I of other samples.
#include "lighting/bench/image_figures.h"

#include <algorithm>
#include <cmath>

#include "lighting/render/image_difference.h"
#include "sim/base/contract.h"

namespace sunfleck {
namespace {

constexpr double kBurntOut = 20.0;

Vec3 colour(const Image& image, std::size_t pixel) {
  return {image.rgb[3 * pixel], image.rgb[3 * pixel + 1], image.rgb[3 * pixel + 2]};
}

double grey(const Vec3& v) { return (v.x + v.y + v.z) / 3.0; }

std::vector<double> greys(const Image& image) {
  std::vector<double> values(image.rgb.size() / 3);
  for (std::size_t p = 0; p < values.size(); ++p) values[p] = grey(colour(image, p));
  return values;
}

double mean_without_brightest(std::vector<double> values) {
  const std::size_t kept = values.size() - values.size() / 100;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(kept - 1), values.end());
  double sum = 0.0;
  for (std::size_t i = 0; i < kept; ++i) sum += values[i];
  return sum / static_cast<double>(kept);
}

bool same_size(const Image& a, const Image& b) {
  return a.width_px == b.width_px && a.height_px == b.height_px && a.rgb.size() == b.rgb.size();
}

// Sums over the pixels that count.
struct Sums {
  double difference = 0, difference_variance = 0;  // of the channels' mean
  double squares = 0, variance = 0, truth_variance = 0;
  std::size_t pixels = 0;
};

void add_pixel(const ImageTruth& truth, std::span<const Image> repeats, std::size_t pixel, Sums& sums) {
  const auto n = static_cast<double>(repeats.size());
  const Vec3 aim = colour(truth.mean, pixel);
  Vec3 mean(0.0);
  for (const Image& image : repeats) mean += colour(image, pixel) / n;
  double grey_squares = 0.0;
  for (const Image& image : repeats) {
    const Vec3 value = colour(image, pixel), miss = value - aim, spread = value - mean;
    sums.squares += glm::dot(miss, miss) / (3.0 * n);
    sums.variance += glm::dot(spread, spread) / (3.0 * (n - 1.0));
    grey_squares += std::pow(grey(spread), 2);
  }
  const Vec3& step = truth.half_step[pixel];
  sums.truth_variance += glm::dot(step, step) / 3.0;
  sums.difference += grey(mean - aim);
  sums.difference_variance += grey_squares / (n * (n - 1.0)) + std::pow(grey(step), 2);
  ++sums.pixels;
}

}  // namespace

ImageTruth image_truth(const Image& first_half, const Image& second_half) {
  SUNFLECK_EXPECTS(same_size(first_half, second_half) && !first_half.rgb.empty());
  ImageTruth truth{first_half, {}, {}, 0.0, 0.0};
  for (std::size_t i = 0; i < truth.mean.rgb.size(); ++i)
    truth.mean.rgb[i] = static_cast<float>((static_cast<double>(first_half.rgb[i]) + second_half.rgb[i]) / 2);
  const std::vector<double> brightness = greys(truth.mean);
  const double most = kBurntOut * mean_without_brightest(brightness);
  double sum = 0.0, variance = 0.0;
  std::size_t counted = 0;
  for (std::size_t p = 0; p < brightness.size(); ++p) {
    truth.half_step.push_back(0.5 * (colour(first_half, p) - colour(second_half, p)));
    truth.counts.push_back(brightness[p] <= most);
    if (!truth.counts[p]) continue;
    sum += brightness[p];
    variance += glm::dot(truth.half_step[p], truth.half_step[p]) / 3.0;
    ++counted;
  }
  truth.brightness = counted > 0 ? sum / static_cast<double>(counted) : 0.0;
  if (truth.brightness > 0.0)
    truth.noise = std::sqrt(variance / static_cast<double>(counted)) / truth.brightness;
  return truth;
}

ImageFigures compare(const ImageTruth& truth, std::span<const Image> repeats) {
  SUNFLECK_EXPECTS(repeats.size() >= 2 && truth.brightness > 0.0);
  Sums sums;
  for (const Image& image : repeats) SUNFLECK_EXPECTS(same_size(image, truth.mean));
  for (std::size_t p = 0; p < truth.counts.size(); ++p)
    if (truth.counts[p]) add_pixel(truth, repeats, p, sums);
  const double n = static_cast<double>(sums.pixels), scale = 1.0 / truth.brightness;
  ImageFigures f;
  f.bias = scale * sums.difference / n;
  f.bias_standard_error = scale * std::sqrt(sums.difference_variance) / n;
  const double mean_square = std::max(0.0, (sums.squares - sums.truth_variance) / n);
  f.rmse = scale * std::sqrt(mean_square);
  f.noise = scale * std::sqrt(sums.variance / n);
  f.floor = std::sqrt(std::max(0.0, f.rmse * f.rmse - f.noise * f.noise));
  f.ssim = 0.0;
  for (const Image& image : repeats) {
    const ImageDifference apart = image_difference(image, truth.mean);
    f.ssim += apart.ssim / static_cast<double>(repeats.size());
    f.flip += apart.flip / static_cast<double>(repeats.size());
  }
  return f;
}

}  // namespace sunfleck
