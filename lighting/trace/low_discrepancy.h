// Points that fill the unit cube evenly: Sobol's sequence in five dimensions (direction numbers of Joe and
// Kuo 2008), scrambled as Owen 1995 does it (nested, every digit permuted depending on those before it), by
// the hash of Laine and Karras 2011 with the constants of Vegdahl 2021. Every scrambled point alone is evenly
// distributed, so means stay unbiased; differently keyed sequences are independent. The first dimensions are
// spread best.
#pragma once

#include <array>
#include <cstdint>

namespace sunfleck::trace {

inline constexpr std::size_t kPointDimensions = 5;
using CubePoint = std::array<double, kPointDimensions>;  // each in [0, 1)

// Point number `index` of the plain sequence as 32-bit fractions.
std::array<std::uint32_t, kPointDimensions> sobol_point(std::uint32_t index);

// Nested scrambling of the binary digits of a fraction.
std::uint32_t owen_scramble(std::uint32_t fraction, std::uint32_t key);

// The sequence of one key.
class ScrambledPoints {
 public:
  explicit ScrambledPoints(std::uint64_t key);
  CubePoint operator()(std::uint32_t index) const;

 private:
  std::array<std::uint32_t, kPointDimensions> keys_;
};

}  // namespace sunfleck::trace
