// IEEE 754 binary16 bits of a float, rounded to nearest even: tiles of a running render travel in it.
#pragma once

#include <cstdint>

namespace sunfleck {

// Beyond 65504 it is infinity; NaN stays NaN.
std::uint16_t half_bits(float value);
float float_from_half_bits(std::uint16_t bits);

}  // namespace sunfleck
