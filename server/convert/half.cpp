// Head comment in half.h.
#include "server/convert/half.h"

#include <bit>
#include <cmath>
#include <limits>

namespace sunfleck {
namespace {

constexpr float kLeastNormal = 6.103515625e-05f;  // 2^-14
constexpr float kTooLarge = 65520.0f;             // rounds to infinity from here on
constexpr std::uint16_t kInfinity = 0x7c00, kNan = 0x7e00;

// Drops 13 mantissa bits, rounding to nearest, ties to even; a carry moves into the exponent as it should.
std::uint16_t rounded_normal(std::uint32_t bits) {
  const std::uint32_t rebiased = bits - ((127u - 15u) << 23);
  return static_cast<std::uint16_t>((rebiased + 0xfff + ((rebiased >> 13) & 1)) >> 13);
}

}  // namespace

std::uint16_t half_bits(float value) {
  const std::uint16_t sign = std::signbit(value) ? 0x8000 : 0;
  const float magnitude = std::abs(value);
  if (std::isnan(value)) return sign | kNan;
  if (magnitude >= kTooLarge) return sign | kInfinity;
  if (magnitude >= kLeastNormal) return sign | rounded_normal(std::bit_cast<std::uint32_t>(magnitude));
  // Subnormal: a whole number of 2^-24; nearbyint rounds ties to even.
  return sign | static_cast<std::uint16_t>(std::nearbyint(std::ldexp(magnitude, 24)));
}

float float_from_half_bits(std::uint16_t bits) {
  const int exponent = (bits >> 10) & 0x1f;
  const int mantissa = bits & 0x3ff;
  float magnitude =
      std::ldexp(static_cast<float>(mantissa + (exponent ? 1024 : 0)), (exponent ? exponent : 1) - 25);
  if (exponent == 0x1f) {
    magnitude = mantissa ? std::numeric_limits<float>::quiet_NaN() : std::numeric_limits<float>::infinity();
  }
  return (bits & 0x8000) ? -magnitude : magnitude;
}

}  // namespace sunfleck
