// Standard errors of anything computed from all rays at once: the computation is repeated kGroups times, each
// time without one group of rays (delete-a-group jackknife). All noise that passes through the iteration is
// inside. Rays are dealt to the groups in turn, every face starting with another group, so that few rays per
// face still fill all groups.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "lighting/trace/low_discrepancy.h"
#include "sim/base/random.h"

namespace sunfleck::trace {

inline constexpr int kGroups = 8;
using GroupValues = std::array<double, kGroups>;

inline std::size_t group_of(std::size_t face, int ray) {
  return (face + static_cast<std::size_t>(ray)) % kGroups;
}
// How many of the first `rays` rays of a face are in a group.
inline int rays_in_group(int rays, std::size_t face, std::size_t group) {
  const int first = static_cast<int>((group + kGroups - face % kGroups) % kGroups);
  return (rays - first + kGroups - 1) / kGroups;
}

// Where ray number `ray` of a face starts and goes, as a point of [0, 1)^4: every group of every face has its
// own scrambled sequence, so that groups are independent of each other, as the jackknife takes them to be.
inline std::array<double, 4> point_of_group(std::uint64_t seed, std::size_t face, int ray) {
  return scrambled_point(mix_seed(seed, face * kGroups + group_of(face, ray)),
                         static_cast<std::uint32_t>(ray / kGroups));
}

// Variance of an estimate from its values without each group; `fewest_rays` per face it rests on. The first
// factor is that of the jackknife (leaving out one of n), the last makes (error / standard error) have
// variance 1 although the standard error is itself an estimate (Student's t, kGroups - 1 degrees).
inline double jackknife_variance(const GroupValues& without, int fewest_rays) {
  if (fewest_rays < 2) return 0.0;
  double mean = 0.0, squares = 0.0;
  for (const double v : without) mean += v / kGroups;
  for (const double v : without) squares += (v - mean) * (v - mean);
  const double n = std::min(fewest_rays, kGroups);
  return (n - 1.0) / n * squares * (kGroups - 1.0) / (kGroups - 3.0);
}

}  // namespace sunfleck::trace
