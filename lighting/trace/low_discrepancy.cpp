#include "lighting/trace/low_discrepancy.h"

#include "sim/base/random.h"

namespace sunfleck::trace {
namespace {

using Directions = std::array<std::uint32_t, 32>;

// From the primitive polynomial's degree and inner coefficients and the first odd numbers m.
constexpr Directions directions(unsigned degree, unsigned coefficients, std::array<std::uint32_t, 3> m) {
  Directions v{};
  for (unsigned i = 0; i < 32; ++i) {
    if (i < degree) {
      v[i] = m[i] << (31 - i);
      continue;
    }
    v[i] = v[i - degree] ^ (v[i - degree] >> degree);
    for (unsigned k = 1; k < degree; ++k)
      if ((coefficients >> (degree - 1 - k)) & 1u) v[i] ^= v[i - k];
  }
  return v;
}

constexpr Directions van_der_corput() {
  Directions v{};
  for (unsigned i = 0; i < 32; ++i) v[i] = 1u << (31 - i);
  return v;
}

constexpr std::array<Directions, kPointDimensions> kDirections = {
    van_der_corput(), directions(1, 0, {1, 0, 0}), directions(2, 1, {1, 3, 0}), directions(3, 1, {1, 3, 1}),
    directions(3, 2, {1, 1, 1})};

std::uint32_t reversed(std::uint32_t x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0F0F0F0Fu) | ((x & 0x0F0F0F0Fu) << 4);
  return __builtin_bswap32(x);
}

}  // namespace

std::array<std::uint32_t, kPointDimensions> sobol_point(std::uint32_t index) {
  std::array<std::uint32_t, kPointDimensions> x{};
  for (std::size_t bit = 0; index != 0; ++bit, index >>= 1)
    if (index & 1u)
      for (std::size_t d = 0; d < kPointDimensions; ++d) x[d] ^= kDirections[d][bit];
  return x;
}

// On reversed digits a hash whose every bit depends on lower ones alone is a nested scrambling.
std::uint32_t owen_scramble(std::uint32_t fraction, std::uint32_t key) {
  std::uint32_t x = reversed(fraction);
  x ^= x * 0x3d20adeau;
  x += key;
  x *= (key >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return reversed(x);
}

ScrambledPoints::ScrambledPoints(std::uint64_t key) {
  for (std::size_t d = 0; d < kPointDimensions; d += 2) {
    const std::uint64_t pair = mix_seed(key, 1 + d / 2);
    keys_[d] = static_cast<std::uint32_t>(pair);
    if (d + 1 < kPointDimensions) keys_[d + 1] = static_cast<std::uint32_t>(pair >> 32);
  }
}

CubePoint ScrambledPoints::operator()(std::uint32_t index) const {
  const std::array<std::uint32_t, kPointDimensions> x = sobol_point(index);
  CubePoint point;
  for (std::size_t d = 0; d < kPointDimensions; ++d) point[d] = owen_scramble(x[d], keys_[d]) * 0x1p-32;
  return point;
}

}  // namespace sunfleck::trace
