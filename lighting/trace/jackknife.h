// Standard errors of anything computed from all rays at once: the computation is repeated kGroups times, each
// time without one group of rays (delete-a-group jackknife). All noise that passes through the iteration is
// inside.
//
// The rays of a face are four scrambled sequences, dealt in turn: few, because a sequence covers a face
// better than independent parts of it do; not two, because light that a few faces receive would leave too few
// numbers to tell its error from. Each sequence of a face is in a group of its own, and the sets of groups go
// round over the faces. Leaving one of n independent parts out moves a mean of variance V by V / (n - 1) on
// average, n times: n / (n - 1) V together.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "lighting/trace/low_discrepancy.h"
#include "sim/base/random.h"

namespace sunfleck::trace {

inline constexpr int kGroups = 8;
using GroupValues = std::array<double, kGroups>;

inline constexpr int kSequences = 4;

// The 14 planes of four points in the space of eight (Steiner's system S(3, 4, 8)): every two groups are
// together in three of them, so that no two are more alike than others.
inline constexpr auto kPlanes = [] {
  std::array<std::array<std::uint8_t, kSequences>, 14> planes{};
  for (unsigned p = 0; p < 14; ++p)
    for (unsigned x = 0, n = 0; x < kGroups; ++x)
      if (std::popcount((1 + p / 2) & x) % 2 == static_cast<int>(p % 2))
        planes[p][n++] = static_cast<std::uint8_t>(x);
  return planes;
}();

inline std::size_t group_of(std::size_t face, int ray) {
  return kPlanes[face % kPlanes.size()][static_cast<std::size_t>(ray % kSequences)];
}
// How many of the first `rays` rays of a face are in a group.
inline int rays_in_group(int rays, std::size_t face, std::size_t group) {
  for (int first = 0; first < std::min(rays, kSequences); ++first)
    if (group_of(face, first) == group) return (rays - first + kSequences - 1) / kSequences;
  return 0;
}

// Where the rays of a face start and go, as points of the unit cube.
class FacePoints {
 public:
  FacePoints(std::uint64_t seed, std::size_t face)
      : sequences_{of(seed, face, 0), of(seed, face, 1), of(seed, face, 2), of(seed, face, 3)} {}
  CubePoint operator()(int ray) const {
    return sequences_[static_cast<std::size_t>(ray % kSequences)](
        static_cast<std::uint32_t>(ray / kSequences));
  }

 private:
  static ScrambledPoints of(std::uint64_t seed, std::size_t face, std::size_t sequence) {
    return ScrambledPoints(mix_seed(seed, kSequences * face + sequence));
  }
  std::array<ScrambledPoints, kSequences> sequences_;
};

// Variance of an estimate from its values without each group; `fewest_rays` per face it rests on. The first
// factor is that of the jackknife (leaving out one of n), the last makes (error / standard error) have
// variance 1 although the standard error is itself an estimate (Student's t, kGroups - 1 degrees).
inline double jackknife_variance(const GroupValues& without, int fewest_rays) {
  if (fewest_rays < 2) return 0.0;
  double mean = 0.0, squares = 0.0;
  for (const double v : without) mean += v / kGroups;
  for (const double v : without) squares += (v - mean) * (v - mean);
  const double n = std::min(fewest_rays, kSequences);
  return (n - 1.0) / n * squares * (kGroups - 1.0) / (kGroups - 3.0);
}

}  // namespace sunfleck::trace
