#include "lighting/render/picture_colour.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include "lighting/sky/perez_sky.h"

namespace sunfleck {
namespace {

// Share of the beam in the light on level ground: 0 cloudy, above 0.6 clear.
double beam_share(const Illumination& light, std::size_t band) {
  const double beam = light.sun_is_up() ? light.bands[band].beam_normal_w_m2 * light.to_sun.z : 0.0;
  const double both = beam + light.bands[band].diffuse_horizontal_w_m2;
  return both > 0.0 ? beam / both : 0.0;
}

// Mean 1 over the channels.
Vec3 clear_sun_tint(const Vec3& to_sun) {
  const double air_mass = glm::min(8.0, relative_air_mass(zenith_of(to_sun)));
  const Vec3 left = glm::exp(-air_mass * Vec3(0.15, 0.22, 0.38));
  return left * (3.0 / (left.x + left.y + left.z));
}

}  // namespace

PictureColour picture_colour(PictureBand band, const Illumination& light, std::size_t band_index) {
  if (band == PictureBand::kOther) return {};
  PictureColour colour;
  colour.leaf_exponent = {1.27, 0.75, 1.58};
  colour.bark_exponent = {0.93, 1.0, 1.09};
  colour.soil_exponent = {0.88, 1.0, 1.15};
  const double clear = glm::min(1.0, beam_share(light, band_index) / 0.6);
  if (light.sun_is_up()) colour.sun_tint = glm::mix(Vec3(1.0), clear_sun_tint(light.to_sun), clear);
  colour.sky_tint = glm::mix(Vec3(1.0), Vec3(0.62, 0.95, 1.45), clear);
  colour.sky_gradient = light.sky == SkyModel::kPerez ? clear : 0.0;
  return colour;
}

Vec3 channel_factor(double albedo, const Vec3& exponent) {
  if (albedo <= 0.0) return Vec3(0.0);
  return glm::pow(Vec3(albedo), exponent - 1.0);
}

}  // namespace sunfleck
