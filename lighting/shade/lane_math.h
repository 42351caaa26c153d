// Elementary functions in single precision without branches or tables, so that compilers turn loops of them
// into vector code. Private to the folder. Errors are tested over their whole range.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace sunfleck {

// exp(x), |x| <= 80 (clamped), 3e-7 relative.
inline float lane_exp(float x) {
  const float limited = x < -80.0f ? -80.0f : x > 80.0f ? 80.0f : x;
  const float binary = 1.44269504f * limited;
  const float shifted = binary + 12582912.0f;  // 1.5 * 2^23: rounds to a whole number
  const float f = (limited - 0.693359375f * (shifted - 12582912.0f)) +
                  2.12194440e-4f * (shifted - 12582912.0f);  // remainder of ln 2 in two parts
  const float power =
      1.0f + f * (1.0f + f * (0.5f + f * (0.166666657f + f * (0.0416672654f + f * 0.00836890004f))));
  const std::int32_t exponent = (std::bit_cast<std::int32_t>(shifted) - 0x4B400000) << 23;
  return std::bit_cast<float>(std::bit_cast<std::int32_t>(power) + exponent);
}

// ln(x) for normal x > 0, 3e-7 absolute near 1, relative elsewhere: x = 2^n m, m in [sqrt 1/2, sqrt 2],
// ln m = 2 artanh(s), s = (m - 1) / (m + 1).
inline float lane_log(float x) {
  const std::int32_t bits = std::bit_cast<std::int32_t>(x);
  const std::int32_t n = (bits - 0x3F3504F3) >> 23;
  const float m = std::bit_cast<float>(bits - (n << 23));
  const float s = (m - 1.0f) / (m + 1.0f), s2 = s * s;
  const float log_m =
      2.0f * s * (1.0f + s2 * (0.333333333f + s2 * (0.2f + s2 * (0.142857143f + s2 * 0.111111f))));
  return log_m + 0.693147181f * static_cast<float>(n);
}

// acos(x) on [-1, 1], 2e-7 + rounding of x (Abramowitz and Stegun 4.4.46).
inline float lane_acos(float x) {
  const float a = std::abs(x);
  const float series =
      1.5707963050f +
      a * (-0.2145988016f +
           a * (0.0889789874f +
                a * (-0.0501743046f +
                     a * (0.0308918810f + a * (-0.0170881256f + a * (0.0066700901f - a * 0.0012624911f))))));
  const float inner = std::sqrt(1.0f - (a < 1.0f ? a : 1.0f)) * series;
  return x < 0 ? 3.14159265f - inner : inner;
}

}  // namespace sunfleck
