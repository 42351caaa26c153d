// See sky_sectors.h.
#include "lighting/transport/sky_sectors.h"

#include <utility>

#include "lighting/sky/sky_by_direction.h"

namespace sunfleck::transport {

namespace {

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
  SkyByDirection seen = sky_by_direction(set.to_source, sky, ground_normal);
  SkySectors sectors{std::move(seen.radiance), std::move(seen.ground_share), seen.open_ground_irradiance, {}};
  set_ground_weights(sectors, set, ground_normal);
  return sectors;
}

}  // namespace sunfleck::transport
