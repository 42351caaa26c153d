#include "lighting/render/raster_samples.h"

#include "lighting/trace/low_discrepancy.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

std::uint32_t reversed(std::uint32_t x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0F0F0F0Fu) | ((x & 0x0F0F0F0Fu) << 4);
  return __builtin_bswap32(x);
}

// Sobol's second dimension is Pascal's triangle modulo 2 on the digits of the first, which is a product of
// five exchanges between halves of them.
std::uint32_t second_dimension(std::uint32_t index) {
  std::uint32_t x = index;
  x ^= (x & 0xAAAAAAAAu) >> 1;
  x ^= (x & 0xCCCCCCCCu) >> 2;
  x ^= (x & 0xF0F0F0F0u) >> 4;
  x ^= (x & 0xFF00FF00u) >> 8;
  x ^= (x & 0xFFFF0000u) >> 16;
  return reversed(x);
}

}  // namespace

SamplePlaces::SamplePlaces(std::uint64_t seed, std::uint64_t pixel, std::uint32_t unit) {
  const std::uint64_t key = mix_seed(mix_seed(mix_seed(seed, pixel), unit), 1);
  const std::uint64_t pair = mix_seed(key, 1);
  shuffle_key_ = static_cast<std::uint32_t>(key >> 32);
  x_key_ = static_cast<std::uint32_t>(pair);
  y_key_ = static_cast<std::uint32_t>(pair >> 32);
}

std::array<double, 2> SamplePlaces::at(std::uint32_t sample) const {
  const std::uint32_t index = trace::owen_scramble(sample, shuffle_key_);
  return {trace::owen_scramble(reversed(index), x_key_) * 0x1p-32,
          trace::owen_scramble(second_dimension(index), y_key_) * 0x1p-32};
}

}  // namespace sunfleck
