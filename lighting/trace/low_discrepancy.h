// Points that fill the unit cube evenly: Sobol's sequence in four dimensions (direction numbers of Joe and
// Kuo 2008), scrambled as Owen 1995 does it (nested, every digit permuted depending on those before it), by
// the hash of Laine and Karras 2011 with the constants of Vegdahl 2021. Every scrambled point alone is evenly
// distributed, so means stay unbiased; differently keyed sequences are independent.
#pragma once

#include <array>
#include <cstdint>

namespace sunfleck::trace {

// Point number `index` of the plain sequence as 32-bit fractions.
std::array<std::uint32_t, 4> sobol_point(std::uint32_t index);

// Nested scrambling of the binary digits of a fraction.
std::uint32_t owen_scramble(std::uint32_t fraction, std::uint32_t key);

// Point number `index` of the sequence of that key, in [0, 1)^4.
std::array<double, 4> scrambled_point(std::uint64_t key, std::uint32_t index);

}  // namespace sunfleck::trace
