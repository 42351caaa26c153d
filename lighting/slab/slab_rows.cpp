// See slab_rows.h. Every loop is written once, in a function that is inlined into two: one for what the build
// targets and one for AVX-512.
#include "lighting/slab/slab_rows.h"

#include <algorithm>
#include <cmath>

#include "lighting/depth/exp_pair.h"
#include "sim/base/contract.h"

#if defined(__x86_64__)
#define SUNFLECK_AVX512 \
  __attribute__((target("avx512f,avx512dq,avx512bw,avx512vl,avx2,fma,prefer-vector-width=512")))
#else
#define SUNFLECK_AVX512
#endif

namespace sunfleck {
namespace {

bool use_avx512(RowCode code) {
#if defined(__x86_64__)
  static const bool has = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                          __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
  return has && code == RowCode::kBest;
#else
  return code == RowCode::kBest && false;
#endif
}

struct Row {
  const float* before;
  const float* behind;
  std::size_t count;
  float* down;
  float* up;
};

[[gnu::always_inline]] inline float deep(float depth) { return depth < kDeepestRow ? depth : kDeepestRow; }

[[gnu::always_inline]] inline void spp_loop(const Row& row, const SppRowMedium& m) {
  const float* __restrict before = row.before, * __restrict behind = row.behind;
  float* __restrict down = row.down, * __restrict up = row.up;
  for (std::size_t i = 0; i < row.count; ++i) {
    const float tau = deep(before[i]), x = deep(behind[i]);
    const auto [to_point, before_1] = exp_pair(m.decay * tau);
    const auto [to_end, behind_1] = exp_pair(m.decay * x);
    const auto turned = exp_pair(m.turned * tau);
    const auto forward = exp_pair(m.forward * tau);
    // 1 - e^(-2 lambda y) from 1 - e^(-lambda y), and the same for the whole thickness.
    const float before_2 = before_1 * (1.0f + to_point), behind_2 = behind_1 * (1.0f + to_end);
    const float across = to_point * to_end, whole_1 = before_1 + to_point * behind_1;
    const float per_denominator =
        to_point / (0.5f * (1.0f + across * across) + m.thickness_sine * whole_1 * (1.0f + across));
    const float there_and_back = to_end * to_end;
    up[i] = (m.ground * there_and_back + m.up_sine * behind_2) * per_denominator;
    const float beam = exp_pair(tau).falling;
    const float all_down = (0.5f * (1.0f + there_and_back) + m.thickness_sine * behind_2) * per_denominator;
    const float shallow = to_point * (turned.falling * forward.risen + turned.risen) +
                          m.down_sine * there_and_back * before_2 * per_denominator;
    const float d = beam + beam < all_down ? all_down - beam : shallow;
    down[i] = d > 0.0f ? d : 0.0f;
  }
}

// spp_h() with its constants.
struct HemisphereRow {
  SppHWaves<double> waves;
  double ground, per_cosine;
  double beside;        // |1 - decay|, at least 1e-12: resonance needs no case
  bool beam_is_faster;  // decay < 1
};

[[gnu::always_inline]] inline void spp_h_loop(const Row& row, const HemisphereRow& h) {
  const float* __restrict before = row.before, * __restrict behind = row.behind;
  float* __restrict down = row.down, * __restrict up = row.up;
  const SppHWaves<double> w = h.waves;
  const double r = w.deep_albedo, per_beside = 1.0 / h.beside, per_sum = 1.0 / (1.0 + w.decay);
  const double wave_share = h.beam_is_faster ? 1.0 : 0.0, beam_share = 1.0 - wave_share;
  for (std::size_t i = 0; i < row.count; ++i) {
    const double tau = deep(before[i]), x = deep(behind[i]);
    const auto wave_t = exp_pair(w.decay * tau), wave_x = exp_pair(w.decay * x);
    const auto beam_t = exp_pair(tau), beam_x = exp_pair(x);
    const auto beside_t = exp_pair(h.beside * tau), beside_x = exp_pair(h.beside * x);
    const double across = wave_t.falling * wave_x.falling, beam_across = beam_t.falling * beam_x.falling;
    const double loss_1 = wave_t.risen + wave_t.falling * wave_x.risen;
    const double beam_loss = beam_t.risen + beam_t.falling * beam_x.risen;
    const double slow_t = wave_share * wave_t.falling + beam_share * beam_t.falling;
    const double slow = wave_share * across + beam_share * beam_across;
    const double fed_with_t = slow_t * beside_t.risen * per_beside;
    const double fed_with = slow * (beside_t.risen + beside_t.falling * beside_x.risen) * per_beside;
    const double fed_against_x = (wave_x.risen + wave_x.falling * beam_x.risen) * per_sum;
    const double fed_p = w.feed_p * fed_with, fed_q = w.feed_q * (loss_1 + across * beam_loss) * per_sum;
    const double determinant = w.one_minus_r * (1.0 + r) + r * (r - h.ground) * loss_1 * (1.0 + across);
    const double q_ground =
        ((h.ground - r) * (fed_p - r * across * fed_q) + h.ground * beam_across * h.per_cosine) / determinant;
    const double p = -wave_t.falling * r * (across * q_ground + fed_q) + w.feed_p * fed_with_t;
    const double q = wave_x.falling * q_ground + w.feed_q * beam_t.falling * fed_against_x;
    const double d = p + r * q, u = r * p + q;
    down[i] = static_cast<float>(d > 0.0 ? d : 0.0);
    up[i] = static_cast<float>(u > 0.0 ? u : 0.0);
  }
}

// compensation_shortfall() with its constants.
struct ShortfallRow {
  float cosine;       // its absolute value
  float rate;         // k, at least 1e-12
  float to_boundary;  // of the exponent per boundary depth
};

[[gnu::always_inline]] inline void shortfall_loop(const float* slab_depth, const float* boundary_depth,
                                                  std::size_t count, const ShortfallRow& s, float* sum_to) {
  const float* __restrict slab_at = slab_depth, * __restrict boundary_at = boundary_depth;
  float* __restrict sum = sum_to;
  for (std::size_t i = 0; i < count; ++i) {
    const float slab = deep(slab_at[i]), boundary = boundary_at[i];
    const float left = slab - boundary * s.cosine, part = left > 0.0f ? left : 0.0f;
    const float whole = exp_pair(s.rate * slab).risen;
    const float share = exp_pair(s.rate * part).risen / (whole > 1e-37f ? whole : 1e-37f);
    const float inside = exp_pair(s.to_boundary * boundary).falling * share;
    const float at_border = boundary > 0.0f ? 0.0f : 1.0f;
    sum[i] += slab > 0.0f ? inside : at_border;
  }
}

[[gnu::always_inline]] inline void fall_loop(const float* depth, std::size_t count, float* sum_to) {
  const float* __restrict depth_at = depth;
  float* __restrict sum = sum_to;
  for (std::size_t i = 0; i < count; ++i) sum[i] += exp_pair(depth_at[i]).falling;
}

SUNFLECK_AVX512 void spp_avx512(const Row& row, const SppRowMedium& medium) { spp_loop(row, medium); }
void spp_plain(const Row& row, const SppRowMedium& medium) { spp_loop(row, medium); }
SUNFLECK_AVX512 void spp_h_avx512(const Row& row, const HemisphereRow& h) { spp_h_loop(row, h); }
void spp_h_plain(const Row& row, const HemisphereRow& h) { spp_h_loop(row, h); }
SUNFLECK_AVX512 void shortfall_avx512(const float* slab, const float* boundary, std::size_t count,
                                      const ShortfallRow& s, float* sum) {
  shortfall_loop(slab, boundary, count, s, sum);
}
void shortfall_plain(const float* slab, const float* boundary, std::size_t count, const ShortfallRow& s,
                     float* sum) {
  shortfall_loop(slab, boundary, count, s, sum);
}

Row checked_row(std::span<const float> before, std::span<const float> behind, std::span<float> down,
                std::span<float> up) {
  SUNFLECK_EXPECTS(behind.size() == before.size() && down.size() == before.size() &&
                   up.size() == before.size());
  return {before.data(), behind.data(), before.size(), down.data(), up.data()};
}

}  // namespace

SppRowMedium row_medium(const SlabMedium<double>& medium) {
  SUNFLECK_EXPECTS(medium.absorption >= 0.0 && medium.absorption <= 1.0);
  const double alpha = medium.absorption, omega = 1.0 - alpha, rho = medium.ground_albedo;
  const double b = omega * medium.backscatter, a = alpha + b;
  const double decay = std::max(std::sqrt(alpha * (alpha + 2.0 * b)), 1e-12);
  const double r = b / (a + decay), one_minus_r = (alpha + decay) / (a + decay);
  const double rho_minus_r = r > 0.5 ? one_minus_r - (1.0 - rho) : rho - r;
  const double sine = 0.5 / decay;
  const auto f = [](double v) { return static_cast<float>(v); };
  return {f(decay),
          f(b * r),
          f(omega * (1.0 - medium.backscatter)),
          f(rho),
          f(sine * b * ((1.0 - rho) + rho * one_minus_r)),
          f(sine * (alpha + b * (1.0 - rho))),
          f(sine * b * rho_minus_r)};
}

void spp_row(std::span<const float> before, std::span<const float> behind, const SppRowMedium& medium,
             std::span<float> down, std::span<float> up, RowCode code) {
  const Row row = checked_row(before, behind, down, up);
  use_avx512(code) ? spp_avx512(row, medium) : spp_plain(row, medium);
}

void spp_h_row(std::span<const float> before, std::span<const float> behind, const HemisphereMedium& medium,
               std::span<float> down, std::span<float> up, RowCode code) {
  SUNFLECK_EXPECTS(medium.diffuse_cosine > 0.0);
  const Row row = checked_row(before, behind, down, up);
  HemisphereRow h{spp_h_waves(medium), medium.ground_albedo, 1.0 / medium.diffuse_cosine, 0.0, false};
  h.beam_is_faster = h.waves.decay < 1.0;
  h.beside = std::max(std::abs(1.0 - h.waves.decay), 1e-12);
  use_avx512(code) ? spp_h_avx512(row, h) : spp_h_plain(row, h);
}

void add_shortfall_row(std::span<const float> before, std::span<const float> behind,
                       std::span<const float> boundary_depth, double cosine, std::span<float> sum,
                       RowCode code) {
  SUNFLECK_EXPECTS(behind.size() == before.size() && boundary_depth.size() == before.size() &&
                   sum.size() == before.size());
  if (cosine == 0.0) return fall_loop(boundary_depth.data(), sum.size(), sum.data());
  const double c = std::abs(cosine), side = cosine > 0.0 ? -1.0 : 1.0;
  const ShortfallRow s{static_cast<float>(c), static_cast<float>(std::clamp(1.0 / c + side, 1e-12, 1e30)),
                       static_cast<float>(1.0 + side * c)};
  const float* slab = cosine > 0.0 ? before.data() : behind.data();
  use_avx512(code) ? shortfall_avx512(slab, boundary_depth.data(), sum.size(), s, sum.data())
                   : shortfall_plain(slab, boundary_depth.data(), sum.size(), s, sum.data());
}

}  // namespace sunfleck
