#include "lighting/sky/illumination.h"

#include <cmath>
#include <cstdio>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

void check_strength(double value, const std::string& where) {
  if (!std::isfinite(value) || value < 0.0)
    throw_invalid(where, "is not a number >= 0", "an irradiance in W m-2");
}

void check_weather(const Illumination& light) {
  if (!(light.sky_clearness >= 1.0 && std::isfinite(light.sky_clearness)))
    throw_invalid("illumination.sky_clearness", "is not a number >= 1",
                  "1 for overcast, above 6.2 for clear");
  if (!(light.sky_brightness >= 0.0 && light.sky_brightness <= 1.0))
    throw_invalid("illumination.sky_brightness", "is outside [0, 1]",
                  "0.05 for a dark sky to 0.6 for a bright one");
}

}  // namespace

SkyRadiance sky_radiance(const Illumination& light) {
  if (light.sky != SkyModel::kPerez) return SkyRadiance(light.sky);
  return SkyRadiance(PerezSky{light.to_sun, light.sky_clearness, light.sky_brightness});
}

std::string sky_key(const Illumination& light) {
  std::string key = to_string(light.sky);
  if (light.sky != SkyModel::kPerez) return key;
  for (const double part :
       {light.to_sun.x, light.to_sun.y, light.to_sun.z, light.sky_clearness, light.sky_brightness}) {
    char text[32];
    std::snprintf(text, sizeof text, " %a", part);  // every bit
    key += text;
  }
  return key;
}

Illumination checked(Illumination light, std::size_t band_count) {
  if (!is_finite(light.to_sun)) throw_invalid("illumination.to_sun", "is not finite", "a direction");
  const double length = glm::length(light.to_sun);
  if (!(length > 0.0)) throw_invalid("illumination.to_sun", "has length 0", "a direction towards the sun");
  if (std::abs(length - 1.0) > 1e-15) light.to_sun /= length;
  if (!(light.sun_half_angle_rad >= 0.0 && light.sun_half_angle_rad <= radians_from_degrees(5.0)))
    throw_invalid("illumination.sun_half_angle_deg", "is outside [0, 5]",
                  "0.265 for the real sun, 0 for a point");
  if (light.bands.size() != band_count)
    throw_invalid("illumination.bands", "has " + std::to_string(light.bands.size()) + " entries",
                  "one for each of the " + std::to_string(band_count) + " bands");
  for (std::size_t b = 0; b < band_count; ++b) {
    const std::string where = "illumination.bands[" + std::to_string(b) + "].";
    check_strength(light.bands[b].beam_normal_w_m2, where + "beam_normal_w_m2");
    check_strength(light.bands[b].diffuse_horizontal_w_m2, where + "diffuse_horizontal_w_m2");
  }
  if (light.sky == SkyModel::kPerez) check_weather(light);
  return light;
}

}  // namespace sunfleck
