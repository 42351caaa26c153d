// See sky_sectors.h. Averages over a lattice of 8192 directions that a quarter turn and the horizon map onto
// itself; a lattice direction between two sectors counts for both.
#include "lighting/transport/sky_sectors.h"

#include <algorithm>
#include <cmath>

namespace sunfleck::transport {

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

// Directions of the set closest to v.
std::vector<std::size_t> nearest(const DirectionSet& set, const Vec3& v) {
  double best = -1.0;
  for (const Vec3& w : set.to_source) best = std::max(best, glm::dot(w, v));
  std::vector<std::size_t> found;
  for (std::size_t j = 0; j < set.count(); ++j)
    if (glm::dot(set.to_source[j], v) > best - 1e-9) found.push_back(j);
  return found;
}

void set_ground_weights(SkySectors& sectors, const DirectionSet& set, const Vec3& ground_normal) {
  sectors.ground_weight_sr.assign(set.count(), 0.0);
  double irradiance = 0.0;
  for (std::size_t j = 0; j < set.count(); ++j) {
    const double cosine = glm::dot(ground_normal, set.to_source[j]);
    if (!(cosine > 1e-9)) continue;
    sectors.ground_weight_sr[j] = set.solid_angle_sr[j] * cosine;
    irradiance += sectors.ground_weight_sr[j] * sectors.sky_radiance[j];
  }
  for (double& weight : sectors.ground_weight_sr) weight *= sectors.open_ground_irradiance / irradiance;
}

}  // namespace

SkySectors sky_sectors(const DirectionSet& set, const SkyRadiance& sky, const Vec3& ground_normal) {
  SkySectors sectors;
  sectors.sky_radiance.assign(set.count(), 0.0);
  sectors.ground_share.assign(set.count(), 0.0);
  sectors.open_ground_irradiance = 0.0;
  std::vector<double> counted(set.count(), 0.0);
  for_each_lattice_direction([&](const Vec3& v) {
    const double above = glm::dot(v, ground_normal);
    const double radiance = above > 0.0 ? sky.radiance(v) : 0.0;
    sectors.open_ground_irradiance += 4.0 * kPi / (kCosines * kTurns) * std::max(0.0, above) * radiance;
    const auto sharing = nearest(set, v);
    for (const std::size_t j : sharing) {
      const double part = 1.0 / static_cast<double>(sharing.size());
      counted[j] += part;
      sectors.sky_radiance[j] += part * radiance;
      sectors.ground_share[j] += above > 0.0 ? 0.0 : part;
    }
  });
  for (std::size_t j = 0; j < set.count(); ++j) {
    sectors.sky_radiance[j] /= counted[j];
    sectors.ground_share[j] /= counted[j];
  }
  set_ground_weights(sectors, set, ground_normal);
  return sectors;
}

}  // namespace sunfleck::transport
