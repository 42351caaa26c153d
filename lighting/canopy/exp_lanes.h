// exp(-x) for x >= 0 in single precision, written so that compilers turn loops of it into vector code; within
// 3e-7 relative up to 80, beyond that the value at 80 (1.8e-35).
#pragma once

#include <bit>
#include <cstdint>

namespace sunfleck {

inline float exp_of_minus(float x) {
  const float limited = x < 80.0f ? x : 80.0f;
  // exp(-x) = 2^n 2^f, f in [-1/2, 1/2].
  const float binary = -1.44269504f * limited;
  const float shifted = binary + 12582912.0f;  // 1.5 * 2^23: rounds to a whole number
  const float f = binary - (shifted - 12582912.0f);
  const float power =
      1.0f +
      f * (0.693147181f +
           f * (0.240226507f +
                f * (0.0555041087f + f * (0.00961812911f + f * (0.00133335581f + f * 0.000154035304f)))));
  const std::int32_t exponent = (std::bit_cast<std::int32_t>(shifted) - 0x4B400000) << 23;
  return std::bit_cast<float>(std::bit_cast<std::int32_t>(power) + exponent);
}

}  // namespace sunfleck
