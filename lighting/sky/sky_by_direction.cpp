#include "lighting/sky/sky_by_direction.h"

#include <algorithm>
#include <cmath>

namespace sunfleck {
namespace {

constexpr int kCosines = 64, kTurns = 128;

template <class Visit>
void for_each_lattice_direction(const Visit& visit) {
  for (int i = 0; i < kCosines; ++i) {
    const double z = 2.0 * (i + 0.5) / kCosines - 1.0, sine = std::sqrt(1.0 - z * z);
    for (int k = 0; k < kTurns; ++k) {
      const double turn = 2.0 * kPi * (k + 0.5) / kTurns;
      visit(Vec3(sine * std::cos(turn), sine * std::sin(turn), z));
    }
  }
}

// Directions of the set closest to v; several where v lies between them.
std::vector<std::size_t> nearest(std::span<const Vec3> set, const Vec3& v) {
  double best = -1.0;
  for (const Vec3& w : set) best = std::max(best, glm::dot(w, v));
  std::vector<std::size_t> found;
  for (std::size_t j = 0; j < set.size(); ++j)
    if (glm::dot(set[j], v) > best - 1e-9) found.push_back(j);
  return found;
}

}  // namespace

SkyByDirection sky_by_direction(std::span<const Vec3> to_source, const SkyRadiance& sky,
                                const Vec3& ground_normal) {
  const std::size_t count = to_source.size();
  SkyByDirection result{std::vector<double>(count), std::vector<double>(count), 0.0};
  std::vector<double> counted(count);
  for_each_lattice_direction([&](const Vec3& v) {
    const double above = glm::dot(v, ground_normal);
    const double radiance = above > 0.0 ? sky.radiance(v) : 0.0;
    result.open_ground_irradiance += 4.0 * kPi / (kCosines * kTurns) * std::max(0.0, above) * radiance;
    const auto sharing = nearest(to_source, v);
    for (const std::size_t j : sharing) {
      const double part = 1.0 / static_cast<double>(sharing.size());
      counted[j] += part;
      result.radiance[j] += part * radiance;
      result.ground_share[j] += above > 0.0 ? 0.0 : part;
    }
  });
  for (std::size_t j = 0; j < count; ++j) {
    result.radiance[j] /= counted[j];
    result.ground_share[j] /= counted[j];
  }
  return result;
}

}  // namespace sunfleck
