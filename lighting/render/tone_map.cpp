#include "lighting/render/tone_map.h"

#include <algorithm>
#include <cmath>

namespace sunfleck {
namespace {

constexpr double kWhitePercentile = 0.99;
constexpr double kMiddle = 0.16;

std::size_t pixel_count(const Image& image) { return image.rgb.size() / 3; }

// Radiance that becomes white; 1 for a black picture. The brightest channel of a pixel counts, so that a blue
// sky stays blue instead of losing its strongest channel.
double white_level(const Image& image) {
  std::vector<float> brightness;
  for (std::size_t p = 0; p < pixel_count(image); ++p)
    brightness.push_back(std::max({image.rgb[3 * p], image.rgb[3 * p + 1], image.rgb[3 * p + 2]}));
  const auto rank =
      static_cast<std::ptrdiff_t>(kWhitePercentile * static_cast<double>(brightness.size() - 1) + 0.5);
  std::nth_element(brightness.begin(), brightness.begin() + rank, brightness.end());
  const float level = brightness[static_cast<std::size_t>(rank)];
  if (level > 0.0f) return level;
  const float brightest = *std::max_element(brightness.begin(), brightness.end());
  return brightest > 0.0f ? brightest : 1.0;
}

double luminance(const float* rgb) { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }

// Radiance that becomes 1 before the curve; 1 for a black picture.
double filmic_level(const Image& image) {
  double sum = 0.0, count = 0.0;
  for (std::size_t p = 0; p < pixel_count(image); ++p) {
    const double y = luminance(&image.rgb[3 * p]);
    if (y > 0.0) sum += std::log(y), count += 1.0;
  }
  return count > 0.0 ? std::exp(sum / count) / kMiddle : 1.0;
}

// The fit of Narkowicz 2015 to the curve of the Academy Color Encoding System; 1 is not yet white.
double filmic(double x) {
  x = std::max(0.0, x);
  return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

std::uint8_t srgb_byte(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255.0 * encoded));
}

}  // namespace

std::vector<std::uint8_t> tone_mapped(const Image& image, const ToneMap& tone) {
  const bool linear = tone.curve == ToneCurve::kLinear;
  const double level = (linear ? white_level(image) : filmic_level(image)) / std::exp2(tone.exposure_stops);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(image.rgb.size());
  for (const float value : image.rgb)
    bytes.push_back(srgb_byte(linear ? value / level : filmic(value / level)));
  return bytes;
}

}  // namespace sunfleck
