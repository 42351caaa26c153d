// See bounce_kernel.h. J without a branch: with x1 = D where the light's depth stays positive, else D0 / c,
//   J = exp(-lo) x1 phi(hi - lo) + exp(-x1) - exp(-D),
// lo and hi the smaller and the larger of D0 and D0 + (1 - c) x1: the exponents at both ends of the first
// part.
#include "lighting/envelope/bounce_kernel.h"

#include <cstdint>
#include <cstring>

#include "lighting/envelope/closed_forms.h"
#include "sim/base/contract.h"

// Builds for processors without 32-byte registers split the vectors; no function here is called from another
// file with one, so how they would be passed does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace sunfleck::envelope {

namespace {

typedef float Floats __attribute__((vector_size(32)));
typedef std::int32_t Ints __attribute__((vector_size(32)));

inline Floats load(const float* from) {
  Floats v;
  std::memcpy(&v, from, sizeof v);
  return v;
}

inline Floats all(float value) { return Floats{} + value; }
inline Floats least(Floats a, Floats b) { return a < b ? a : b; }
inline Floats most(Floats a, Floats b) { return a > b ? a : b; }

// exp(-x) for x >= 0, 2e-7 relative; exp(-87) beyond 87.
inline Floats decay(Floats x) {
  const Floats y = least(x, all(87.0f));
  const Ints n = __builtin_convertvector(y * 1.44269504f + 0.5f, Ints);  // whole powers of 1/2
  const Floats whole = __builtin_convertvector(n, Floats);
  const Floats r = (y - whole * 0.693359375f) + whole * 2.12194440e-4f;  // |r| <= 0.35
  // exp(-r) to the 7th order.
  Floats sum = all(-1.0f / 5040);
  sum = sum * r + 1.0f / 720;
  sum = sum * r - 1.0f / 120;
  sum = sum * r + 1.0f / 24;
  sum = sum * r - 1.0f / 6;
  sum = sum * r + 0.5f;
  sum = sum * r - 1.0f;
  sum = sum * r + 1.0f;
  const Ints power = (127 - n) << 23;
  Floats scale;
  std::memcpy(&scale, &power, sizeof scale);
  return sum * scale;
}

// phi(y) for y >= 0: its series below 1/2, where 1 - exp(-y) would cancel.
inline Floats mean_decay_of(Floats y, Floats decay_of_y) {
  Floats series = all(-1.0f / 40320);
  series = series * y + 1.0f / 5040;
  series = series * y - 1.0f / 720;
  series = series * y + 1.0f / 120;
  series = series * y - 1.0f / 24;
  series = series * y + 1.0f / 6;
  series = series * y - 0.5f;
  series = series * y + 1.0f;
  const Floats direct = (1.0f - decay_of_y) / most(y, all(0.5f));
  return y < 0.5f ? series : direct;
}

inline Floats bounce(Floats d0, Floats c, Floats d, Floats through) {
  const Floats turn = d0 / most(c, all(1e-6f));
  const Floats x1 = c * d > d0 ? least(turn, d) : d;
  const Floats end = most(d0 + (1.0f - c) * x1, all(0.0f));
  const Floats lo = least(d0, end), span = most(d0, end) - lo;
  const Floats within = decay(lo) * x1 * mean_decay_of(span, decay(span));
  const Floats beyond = x1 < d ? decay(x1) - through : all(0.0f);
  return within + most(beyond, all(0.0f));
}

}  // namespace

void bounce_row(std::span<const float> depth_to_light, std::span<const float> approach, float sector_depth,
                std::span<float> integral) {
  SUNFLECK_EXPECTS(integral.size() % kLaneCount == 0 && depth_to_light.size() == integral.size() &&
                   approach.size() == integral.size());
  const Floats through = decay(all(sector_depth));
  for (std::size_t k = 0; k < integral.size(); k += kLaneCount) {
    const Floats j = bounce(load(&depth_to_light[k]), load(&approach[k]), all(sector_depth), through);
    std::memcpy(&integral[k], &j, sizeof j);
  }
}

void bounce_sectors(float depth_to_light, std::span<const float> approach,
                    std::span<const float> sector_depth, std::span<float> integral) {
  SUNFLECK_EXPECTS(integral.size() % kLaneCount == 0 && sector_depth.size() == integral.size() &&
                   approach.size() == integral.size());
  for (std::size_t j = 0; j < integral.size(); j += kLaneCount) {
    const Floats depth = load(&sector_depth[j]);
    const Floats value = bounce(all(depth_to_light), load(&approach[j]), depth, decay(depth));
    std::memcpy(&integral[j], &value, sizeof value);
  }
}

void bounce_row_plain(std::span<const float> depth_to_light, std::span<const float> approach,
                      float sector_depth, std::span<float> integral) {
  SUNFLECK_EXPECTS(depth_to_light.size() == integral.size() && approach.size() == integral.size());
  for (std::size_t k = 0; k < integral.size(); ++k)
    integral[k] =
        static_cast<float>(one_bounce_integral<double>(depth_to_light[k], approach[k], sector_depth));
}

void bounce_sectors_plain(float depth_to_light, std::span<const float> approach,
                          std::span<const float> sector_depth, std::span<float> integral) {
  SUNFLECK_EXPECTS(sector_depth.size() == integral.size() && approach.size() == integral.size());
  for (std::size_t j = 0; j < integral.size(); ++j)
    integral[j] =
        static_cast<float>(one_bounce_integral<double>(depth_to_light, approach[j], sector_depth[j]));
}

void transmittances(std::span<const float> depth, std::span<float> through) {
  SUNFLECK_EXPECTS(depth.size() % kLaneCount == 0 && depth.size() == through.size());
  for (std::size_t k = 0; k < depth.size(); k += kLaneCount) {
    const Floats value = decay(load(&depth[k]));
    std::memcpy(&through[k], &value, sizeof value);
  }
}

float row_product(std::span<const float> a, std::span<const float> b, std::span<const float> c) {
  SUNFLECK_EXPECTS(a.size() % kLaneCount == 0 && a.size() == b.size() && a.size() == c.size());
  Floats sum{};
  for (std::size_t k = 0; k < a.size(); k += kLaneCount) sum += load(&a[k]) * load(&b[k]) * load(&c[k]);
  return ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7]));
}

}  // namespace sunfleck::envelope
