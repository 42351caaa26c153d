#include "lighting/sky/perez_sky.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sunfleck {
namespace {

// [Perez93] Table 1: for each range of clearness, four coefficients of a, b, c, d and e.
using Row = std::array<double, 20>;
constexpr std::array<Row, 8> kCoefficients = {{
    {1.3525, -0.2576, -0.2690, -1.4366, -0.7670, 0.0007, 1.2734, -0.1233, 2.8000,  0.6004,
     1.2375, 1.0000,  1.8734,  0.6297,  0.9738,  0.2809, 0.0356, -0.1246, -0.5718, 0.9938},
    {-1.2219, -0.7730, 1.4148,  1.1016,  -0.2054, 0.0367, -3.9128, 0.9156, 6.9750,  0.1774,
     6.4477,  -0.1239, -1.5798, -0.5081, -1.7812, 0.1080, 0.2624,  0.0672, -0.2190, -0.4285},
    {-1.1000,  -0.2515, 0.8952,  0.0156, 0.2782, -0.1812, -4.5000, 1.1766, 24.7219, -13.0812,
     -37.7000, 34.8438, -5.0000, 1.5218, 3.9229, -2.6204, -0.0156, 0.1597, 0.4199,  -0.5562},
    {-0.5484,  -0.6654, -0.2672, 0.7117, 0.7234, -0.6219, -5.6812, 2.6297,  33.3389, -18.3000,
     -62.2500, 52.0781, -3.5000, 0.0016, 1.1477, 0.1062,  0.4659,  -0.3296, -0.0876, -0.0329},
    {-0.6000,  -0.3566, -2.5000, 2.3250,  0.2937, 0.0496, -5.6812, 1.8415, 21.0000, -4.7656,
     -21.5906, 7.2492,  -3.5000, -0.1554, 1.4062, 0.3988, 0.0032,  0.0766, -0.0656, -0.1294},
    {-1.0156, -0.3670, 1.0078,  1.4051,  0.2875,  -0.5328, -3.8500, 3.3750, 14.0000, -0.9999,
     -7.1406, 7.5469,  -3.4000, -0.1078, -1.0750, 1.5702,  -0.0672, 0.4016, 0.3017,  -0.4844},
    {-1.0000, 0.0211,  0.5025,  -0.5119, -0.3000, 0.1922, 0.7023, -1.6317, 19.0000, -5.0000,
     1.2438,  -1.9094, -4.0000, 0.0250,  0.3844,  0.2656, 1.0468, -0.3788, -2.4517, 1.4656},
    {-1.0500,  0.0289,  0.4260,  0.3590, -0.3250, 0.1156, 0.7781, 0.0025,  31.0625, -14.5000,
     -46.1148, 55.3750, -7.2312, 0.4050, 13.3500, 0.6234, 1.5000, -0.6426, 1.8564,  0.5636},
}};
// Upper ends of the ranges of clearness, but for the last.
constexpr std::array<double, 7> kClearnessEnds = {1.065, 1.230, 1.500, 1.950, 2.800, 4.500, 6.200};
// Of any sky, and of skies in the ranges 1 to 4 and 5 to 7.
constexpr double kLeastBrightness = 0.01, kLeastHalfClear = 0.2, kLeastClear = 0.05;
constexpr double kMostBrightness = 0.6;

}  // namespace

Vec3 lifted_to_horizon(const Vec3& to_sun) {
  if (to_sun.z >= 0.0) return to_sun;
  const double across = std::hypot(to_sun.x, to_sun.y);
  return across > 0.0 ? Vec3(to_sun.x / across, to_sun.y / across, 0.0) : Vec3(0.0, 1.0, 0.0);
}

double relative_air_mass(double zenith_rad) {
  const double zenith_deg = std::clamp(degrees_from_radians(zenith_rad), 0.0, 90.0);
  return 1.0 /
         (std::cos(radians_from_degrees(zenith_deg)) + 0.50572 * std::pow(96.07995 - zenith_deg, -1.6364));
}

PerezSky perez_sky(const Vec3& to_sun, double beam_normal, double diffuse_horizontal,
                   double extraterrestrial_normal) {
  const double zenith = std::min(zenith_of(to_sun), 0.5 * kPi);
  if (!(diffuse_horizontal > 0.0) || !(extraterrestrial_normal > 0.0)) return {to_sun, 1.0, kLeastBrightness};
  const double turbid = 1.041 * zenith * zenith * zenith;
  const double beam = to_sun.z > 0.0 ? beam_normal : 0.0;
  // [Perez90] Eq. 1 and 2.
  const double clearness = (1.0 + beam / diffuse_horizontal + turbid) / (1.0 + turbid);
  const double brightness = relative_air_mass(zenith) * diffuse_horizontal / extraterrestrial_normal;
  return {to_sun, clearness, std::clamp(brightness, kLeastBrightness, kMostBrightness)};
}

PerezShape perez_shape(const PerezSky& sky) {
  const double zenith = std::min(zenith_of(sky.to_sun), 0.5 * kPi);
  const double clearness = sky.to_sun.z > 0.0 ? sky.clearness : 1.0;
  const auto range = static_cast<std::size_t>(
      std::upper_bound(kClearnessEnds.begin(), kClearnessEnds.end(), clearness) - kClearnessEnds.begin());
  const double least = range == 0 ? kLeastBrightness : range <= 4 ? kLeastHalfClear : kLeastClear;
  const double brightness = std::clamp(sky.brightness, least, kMostBrightness);
  const Row& k = kCoefficients[range];
  // [Perez93] Eq. 6.
  const auto at = [&](std::size_t i) {
    return k[i] + k[i + 1] * zenith + brightness * (k[i + 2] + k[i + 3] * zenith);
  };
  PerezShape shape{at(0), at(4), at(8), at(12), at(16)};
  if (range == 0) {
    // [Perez93] Eq. 7 and 8, for overcast skies.
    shape.c = std::exp(std::pow(brightness * (k[8] + k[9] * zenith), k[10])) - k[11];
    shape.d = -std::exp(brightness * (k[12] + k[13] * zenith)) + k[14] + brightness * k[15];
  }
  shape.b = std::min(shape.b, -0.05);
  shape.d = std::min(shape.d, 0.0);
  return shape;
}

double perez_gradation(const PerezShape& shape, double cos_zenith) {
  constexpr double kHorizon = 1e-6;  // exp(b / cos) is 0 there, as b <= -0.05
  return std::max(0.0, 1.0 + shape.a * std::exp(shape.b / std::max(cos_zenith, kHorizon)));
}

double perez_halo(const PerezShape& shape, double cos_to_sun) {
  const double cosine = std::clamp(cos_to_sun, -1.0, 1.0);
  return std::max(0.0, 1.0 + shape.c * std::exp(shape.d * std::acos(cosine)) + shape.e * cosine * cosine);
}

double perez_relative_radiance(const PerezShape& shape, double cos_zenith, double cos_to_sun) {
  return perez_gradation(shape, cos_zenith) * perez_halo(shape, cos_to_sun);
}

}  // namespace sunfleck
