#include "lighting/links/owen_points.h"

#include "sim/base/contract.h"
#include "sim/base/random.h"

namespace sunfleck::links {
namespace {

constexpr std::size_t kBits = 10;  // of the index
using Directions = std::array<std::array<std::uint32_t, kBits>, 4>;

// Bit `k` of the index toggles these bits of the fraction. Primitive polynomials and first m of Joe and Kuo:
// none; x + 1 (1); x^2 + x + 1 (1, 3); x^3 + x + 1 (1, 3, 1).
constexpr Directions directions() {
  Directions v{};
  for (std::size_t k = 0; k < kBits; ++k) v[0][k] = 1u << (31 - k);
  constexpr std::array<std::size_t, 4> degree = {0, 1, 2, 3};
  constexpr std::array<std::uint32_t, 4> inner = {0, 0, 1, 1};  // coefficients between the first and last
  constexpr std::array<std::array<std::uint32_t, 3>, 4> m = {{{}, {1}, {1, 3}, {1, 3, 1}}};
  for (std::size_t d = 1; d < 4; ++d) {
    const std::size_t s = degree[d];
    for (std::size_t k = 0; k < s; ++k) v[d][k] = m[d][k] << (31 - k);
    for (std::size_t k = s; k < kBits; ++k) {
      v[d][k] = v[d][k - s] ^ (v[d][k - s] >> s);
      for (std::size_t i = 1; i < s; ++i)
        if ((inner[d] >> (s - 1 - i)) & 1u) v[d][k] ^= v[d][k - i];
    }
  }
  return v;
}
constexpr Directions kDirections = directions();

std::uint32_t reversed(std::uint32_t x) {
  x = ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  x = ((x & 0x0F0F0F0Fu) << 4) | ((x >> 4) & 0x0F0F0F0Fu);
  return __builtin_bswap32(x);
}

// A hash in which every bit depends on lower bits only (Burley 2020, listing 2, after Laine and Karras).
std::uint32_t laine_karras(std::uint32_t x, std::uint32_t seed) {
  x += seed;
  x ^= x * 0x6C50B47Cu;
  x ^= x * 0xB82F1E52u;
  x ^= x * 0xC7AFE638u;
  x ^= x * 0x8D22F6E6u;
  return x;
}

}  // namespace

std::array<std::uint32_t, 4> sobol_bits(std::uint32_t index) {
  SUNFLECK_EXPECTS(index < 1u << kBits);
  std::array<std::uint32_t, 4> bits{};
  for (std::size_t k = 0; index != 0; ++k, index >>= 1)
    if (index & 1u)
      for (std::size_t d = 0; d < 4; ++d) bits[d] ^= kDirections[d][k];
  return bits;
}

Point4 owen_point(std::uint32_t index, std::uint64_t seed) {
  const std::array<std::uint32_t, 4> bits = sobol_bits(index);
  Point4 p;
  for (std::size_t d = 0; d < 4; ++d) {
    const auto key = static_cast<std::uint32_t>(mix_seed(seed, d) >> 32);
    p[d] = reversed(laine_karras(reversed(bits[d]), key)) * 0x1p-32;
  }
  return p;
}

}  // namespace sunfleck::links
