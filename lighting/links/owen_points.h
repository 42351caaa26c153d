// Points that fill the four-dimensional unit cube evenly, for any power of two of them: Sobol's sequence with
// the direction numbers of Joe and Kuo 2008, "Constructing Sobol sequences with better two-dimensional
// projections", scrambled as Owen 1995 does, by the hash of Burley 2020, "Practical hash-based Owen
// scrambling" (JCGT 9(4), sec. 3.2). Every point alone is uniform, so any mean over them is unbiased; two
// seeds give independent scrambles.
#pragma once

#include <array>
#include <cstdint>

namespace sunfleck::links {

using Point4 = std::array<double, 4>;  // each in [0, 1)

// Point number `index` < 1024 of the set named by `seed`.
Point4 owen_point(std::uint32_t index, std::uint64_t seed);

// The same set unscrambled: the first 1024 points of Sobol's sequence as 32-bit fractions.
std::array<std::uint32_t, 4> sobol_bits(std::uint32_t index);

}  // namespace sunfleck::links
