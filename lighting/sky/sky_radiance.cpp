#include "lighting/sky/sky_radiance.h"

#include <cmath>

#include "lighting/sky/sky_patches.h"
#include "sim/base/contract.h"

namespace sunfleck {
namespace {

// One set of directions for all skies: patches of 5 degrees, five by two points in each.
const HemisphereGrid::Points& normalising_points() {
  static const HemisphereGrid::Points points = HemisphereGrid::equal_area(5.0).points(5, 2);
  return points;
}

}  // namespace

std::string to_string(SkyModel model) {
  switch (model) {
    case SkyModel::kUniform:
      return "uniform";
    case SkyModel::kStandardOvercast:
      return "standard_overcast";
    case SkyModel::kPerez:
      break;
  }
  return "perez";
}

double relative_sky_radiance(SkyModel model, double cos_zenith) {
  SUNFLECK_EXPECTS(model != SkyModel::kPerez);
  if (!(cos_zenith > 0.0)) return 0.0;
  // Both integrate to 1 over the cosine-weighted hemisphere: pi L = 1, and Lz * 7 pi / 9 = 1 with L = Lz
  // (1+2c)/3.
  if (model == SkyModel::kUniform) return 1.0 / kPi;
  return (9.0 / (7.0 * kPi)) * (1.0 + 2.0 * cos_zenith) / 3.0;
}

SkyRadiance::SkyRadiance(SkyModel model) : model_(model) { SUNFLECK_EXPECTS(model != SkyModel::kPerez); }

SkyRadiance::SkyRadiance(const PerezSky& sky)
    : model_(SkyModel::kPerez), shape_(perez_shape(sky)), to_sun_(lifted_to_horizon(sky.to_sun)) {
  const HemisphereGrid::Points& points = normalising_points();
  double horizontal = 0;
  for (std::size_t i = 0; i < points.direction.size(); ++i)
    horizontal += radiance(points.direction[i]) * points.direction[i].z * points.solid_angle_sr[i];
  SUNFLECK_ENSURES(horizontal > 0.0);
  scale_ = 1.0 / horizontal;
}

double SkyRadiance::radiance(const Vec3& to_sky) const {
  if (is_round()) return relative_sky_radiance(model_, to_sky.z);
  if (!(to_sky.z > 0.0)) return 0.0;
  return scale_ * perez_relative_radiance(shape_, to_sky.z, glm::dot(to_sky, to_sun_));
}

double SkyRadiance::ring_mean(double cos_zenith) const {
  if (is_round()) return relative_sky_radiance(model_, cos_zenith);
  constexpr int kAzimuths = 72;
  const double zenith = std::acos(std::fmin(cos_zenith, 1.0)), sun_azimuth = azimuth_of(to_sun_);
  // The halo is even on both sides of the sun: half a turn does.
  double sum = 0;
  for (int i = 0; i < kAzimuths; ++i)
    sum += radiance(direction_from_azimuth_zenith(sun_azimuth + kPi * (i + 0.5) / kAzimuths, zenith));
  return sum / kAzimuths;
}

}  // namespace sunfleck
