// What one face receives: first light from the sums over its rays, scattered light from the radiosities its
// rays met.
#include <algorithm>

#include "lighting/trace/radiosity.h"

namespace sunfleck::trace {
namespace {

// Mean over rays, and over all rays but those of each group, from the sums per group.
struct Means {
  double all = 0;
  GroupValues without{};
};
template <class T>
Means means_of(const std::array<T, kGroups>& sums, int rays, std::size_t dealt_from) {
  Means m;
  if (rays == 0) return m;
  double total = 0.0;
  for (const T s : sums) total += static_cast<double>(s);
  m.all = total / rays;
  for (std::size_t g = 0; g < kGroups; ++g) {
    const int left = rays - rays_in_group(rays, dealt_from, g);
    m.without[g] = left > 0 ? (total - static_cast<double>(sums[g])) / left : m.all;
  }
  return m;
}

std::array<std::uint32_t, kGroups> count_beyond(const BandProblem& problem, std::size_t face) {
  std::array<std::uint32_t, kGroups> count{};
  if (problem.sources.ground_beyond_w_m2 == 0.0) return count;
  const std::uint32_t* row = problem.matrix.row(face);
  const std::uint32_t beyond = problem.receivers.ground_beyond();
  for (int k = 0; k < problem.matrix.rays; ++k)
    if (row[k] == beyond) ++count[group_of(face, k)];
  return count;
}

}  // namespace

FirstLight first_light(const BandProblem& problem, std::size_t face) {
  const BandSources& s = problem.sources;
  const Means sun = problem.sun.rays > 0 ? means_of(problem.sun.received[face], problem.sun.rays,
                                                    problem.receivers.surface_of(face))
                                         : Means{};
  const Means sky = means_of(problem.matrix.sky[face], problem.matrix.rays, face);
  const Means beyond = means_of(count_beyond(problem, face), problem.matrix.rays, face);
  FirstLight light{s.beam_w_m2 * sun.all, s.diffuse_w_m2 * sky.all, s.ground_beyond_w_m2 * beyond.all, {}};
  for (std::size_t g = 0; g < kGroups; ++g)
    light.without_group[g] = s.beam_w_m2 * sun.without[g] + s.diffuse_w_m2 * sky.without[g] +
                             s.ground_beyond_w_m2 * beyond.without[g];
  return light;
}

double mean_met(const BandProblem& problem, const Radiosity<1>& radiosity, std::size_t face) {
  const std::uint32_t* row = problem.matrix.row(face);
  const int rays = problem.matrix.rays;
  std::array<double, 4> sum{};  // four chains of additions
  int k = 0;
  for (; k + 4 <= rays; k += 4)
    for (int i = 0; i < 4; ++i) sum[static_cast<std::size_t>(i)] += radiosity.of_face[row[k + i]][0];
  for (; k < rays; ++k) sum[0] += radiosity.of_face[row[k]][0];
  return ((sum[0] + sum[1]) + (sum[2] + sum[3])) / rays;
}

GroupMeans mean_met(const BandProblem& problem, const Radiosity<kGroups>& radiosity, std::size_t face) {
  constexpr int kBlock = 8 * kGroups;  // short sums in single precision, long ones in double
  const std::uint32_t* row = problem.matrix.row(face);
  const int rays = problem.matrix.rays;
  GroupValues all{}, own{};
  for (int begin = 0; begin < rays; begin += kBlock) {
    std::array<float, kGroups> block{}, block_own{};
    const int end = std::min(rays, begin + kBlock);
    for (int k = begin; k < end; ++k) {
      const std::array<float, kGroups>& met = radiosity.of_face[row[k]];
      for (std::size_t g = 0; g < kGroups; ++g) block[g] += met[g];
      const std::size_t group = group_of(face, k);
      block_own[group] += met[group];
    }
    for (std::size_t g = 0; g < kGroups; ++g) all[g] += block[g], own[g] += block_own[g];
  }
  GroupMeans means;
  for (std::size_t g = 0; g < kGroups; ++g) {
    const int left = rays - rays_in_group(rays, face, g);
    means.by_all_rays[g] = all[g] / rays;
    means.without_own_rays[g] = left > 0 ? (all[g] - own[g]) / left : means.by_all_rays[g];
  }
  return means;
}

}  // namespace sunfleck::trace
