// Head comment in light_spec_message.h.
#include "server/convert/light_spec_message.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "server/convert/light_selection_message.h"
#include "server/convert/method_options.h"
#include "sunfleck/v1/light.pb.h"

namespace sunfleck {
namespace {

constexpr double kBrightest_w_m2 = 1e6;

Method method_from_message(v1::Method method, const std::string& field, Violations& violations) {
  switch (method) {
    case v1::METHOD_REFERENCE:
      return Method::kReference;
    case v1::METHOD_SINGLE_SCATTERING:
      return Method::kSingleScattering;
    case v1::METHOD_SPP:
      return Method::kSpp;
    case v1::METHOD_SPP_G:
      return Method::kSppG;
    case v1::METHOD_ENVELOPE:
      return Method::kEnvelope;
    case v1::METHOD_ENVELOPE_MARCHED:
      return Method::kEnvelopeMarched;
    case v1::METHOD_GRID:
      return Method::kGrid;
    case v1::METHOD_SPP_H:
      return Method::kSppH;
    case v1::METHOD_SPP_MARCHED:
      return Method::kSppMarched;
    case v1::METHOD_ENVELOPE_FULL:
      return Method::kEnvelopeFull;
    case v1::METHOD_LINKS:
      return Method::kLinks;
    case v1::METHOD_WORLD:
      return Method::kWorld;
    case v1::METHOD_AUTO:
      return Method::kAuto;
    default:
      break;
  }
  violations.add(field, method == v1::METHOD_UNSPECIFIED
                            ? "must be given: reference, single_scattering, spp, spp_g, spp_h, spp_marched, "
                              "envelope, envelope_marched, envelope_full, grid, links, world or auto"
                            : "unknown method " + std::to_string(method));
  return Method::kReference;
}

SkyModel sky_from_message(v1::SkyModel sky, const std::string& field, Violations& violations) {
  switch (sky) {
    case v1::SKY_MODEL_UNSPECIFIED:
    case v1::SKY_MODEL_UNIFORM:
      return SkyModel::kUniform;
    case v1::SKY_MODEL_STANDARD_OVERCAST:
      return SkyModel::kStandardOvercast;
    case v1::SKY_MODEL_PEREZ:
      return SkyModel::kPerez;
    default:
      break;
  }
  violations.add(field, "unknown sky model " + std::to_string(sky));
  return SkyModel::kUniform;
}

void read_band(const v1::Band& band, const std::string& field, std::set<std::string>& names,
               Violations& violations, LightRequest& request) {
  violations.text(field + ".name", band.name(), 64);
  if (!names.insert(band.name()).second) {
    violations.add(field + ".name", "must be unique, '" + clipped(band.name()) + "' was there before");
  }
  violations.number(field + ".soil_albedo", band.soil_albedo(), 0, 1);
  violations.number(field + ".beam_normal_w_m2", band.beam_normal_w_m2(), 0, kBrightest_w_m2);
  violations.number(field + ".diffuse_horizontal_w_m2", band.diffuse_horizontal_w_m2(), 0, kBrightest_w_m2);
  request.optics.bands.push_back(band.name());
  request.optics.soil_albedo.push_back(band.soil_albedo());
  request.light.bands.push_back({band.beam_normal_w_m2(), band.diffuse_horizontal_w_m2()});
}

void check_face(const std::string& field, const char* face, double reflectance, double transmittance,
                Violations& violations) {
  const std::string end = std::string("_") + face;
  const bool r = violations.number(field + ".leaf_reflectance" + end, reflectance, 0, 1);
  const bool t = violations.number(field + ".leaf_transmittance" + end, transmittance, 0, 1);
  if (r && t && reflectance + transmittance > 1) {
    violations.add(
        field + ".leaf_transmittance" + end,
        "reflectance + transmittance must be at most 1, got " + std::to_string(reflectance + transmittance));
  }
}

void read_bands(const v1::LightSpec& message, const std::string& field, const Limits& limits,
                Violations& violations, LightRequest& request) {
  const auto size = [](int n) { return static_cast<std::size_t>(n); };
  const bool bands_fit = violations.count(field + ".bands", size(message.bands_size()), 1, limits.bands);
  const bool overrides_fit =
      violations.count(field + ".overrides", size(message.overrides_size()), 0, limits.overrides);
  if (!bands_fit || !overrides_fit) return;
  std::set<std::string> names;
  for (int i = 0; i < message.bands_size(); ++i) {
    read_band(message.bands(i), at(field + ".bands", size(i)), names, violations, request);
  }
  for (int i = 0; i < message.overrides_size(); ++i) {
    request.optics.overrides.push_back(
        override_from_message(message.overrides(i), at(field + ".overrides", size(i)), names, violations));
  }
}

Vec3 direction_from_message(const v1::Vector3& message, const std::string& field, Violations& violations) {
  const Vec3 to_sun(message.x(), message.y(), message.z());
  const double length = glm::length(to_sun);
  if (!is_finite(to_sun) || !(length > 1e-12) || !(length < 1e12)) {
    violations.add(field, "must be a finite direction of a length in (1e-12, 1e12)");
  }
  return to_sun;
}

Vec3 direction_from_angles(const v1::SolarAngles& angles, const std::string& field, Violations& violations) {
  violations.number(field + ".solar_zenith_angle_deg", angles.solar_zenith_angle_deg(), 0, 90);
  violations.number(field + ".solar_azimuth_angle_deg", angles.solar_azimuth_angle_deg(), -360, 360);
  return direction_from_azimuth_zenith(radians_from_degrees(angles.solar_azimuth_angle_deg()),
                                       radians_from_degrees(angles.solar_zenith_angle_deg()));
}

void read_sun(const v1::LightSpec& message, const std::string& field, Violations& violations,
              Illumination& light) {
  violations.number(field + ".sun_half_angle_rad", message.sun_half_angle_rad(), 0, radians_from_degrees(5));
  light.sun_half_angle_rad = message.sun_half_angle_rad();
  if (message.has_direction_to_sun()) {
    light.to_sun =
        direction_from_message(message.direction_to_sun(), field + ".direction_to_sun", violations);
  } else if (message.has_solar_angles()) {
    light.to_sun = direction_from_angles(message.solar_angles(), field + ".solar_angles", violations);
  } else {
    for (const BandLight& band : light.bands) {
      if (!(band.beam_normal_w_m2 > 0)) continue;
      violations.add(field + ".sun", "must be given where a band has beam_normal_w_m2 > 0");
      break;
    }
  }
}

void read_sky(const v1::LightSpec& message, const std::string& field, Violations& violations,
              Illumination& light) {
  light.sky = sky_from_message(message.sky(), field + ".sky", violations);
  if (message.has_sky_clearness()) light.sky_clearness = message.sky_clearness();
  if (message.has_sky_brightness()) light.sky_brightness = message.sky_brightness();
  violations.number(field + ".sky_clearness", light.sky_clearness, 1, 1000);
  violations.number(field + ".sky_brightness", light.sky_brightness, 0, 1);
}

Skipping skipping_from_message(v1::Skipping skip, const std::string& field, Violations& violations) {
  if (skip == v1::SKIPPING_NEVER) return Skipping::kNever;
  if (skip != v1::SKIPPING_UNSPECIFIED && skip != v1::SKIPPING_AUTO)
    violations.add(field, "unknown value " + std::to_string(skip));
  return Skipping::kAuto;
}

}  // namespace

OpticsOverride override_from_message(const v1::OpticsOverride& message, const std::string& field,
                                     const std::set<std::string>& bands, Violations& violations) {
  violations.text(field + ".material", message.material(), 200);
  if (!bands.contains(message.band())) {
    violations.add(field + ".band",
                   "must be one of the request's bands, got '" + clipped(message.band()) + "'");
  }
  check_face(field, "front", message.leaf_reflectance_front(), message.leaf_transmittance_front(),
             violations);
  check_face(field, "back", message.leaf_reflectance_back(), message.leaf_transmittance_back(), violations);
  violations.number(field + ".bark_reflectance", message.bark_reflectance(), 0, 1);
  const LeafOptics leaf{message.leaf_reflectance_front(), message.leaf_reflectance_back(),
                        message.leaf_transmittance_front(), message.leaf_transmittance_back()};
  return {message.material(), message.band(), {leaf, message.bark_reflectance()}};
}

LightRequest light_request_from_message(const v1::LightSpec& message, const std::string& field,
                                        const Limits& limits, Violations& violations) {
  LightRequest request;
  request.method = method_from_message(message.method(), field + ".method", violations);
  read_bands(message, field, limits, violations, request);
  read_sun(message, field, violations, request.light);
  read_sky(message, field, violations, request.light);
  read_method_options(message, field, violations, request);
  request.reference.memory_limit_bytes = limits.request_memory_bytes;
  request.links.memory_limit_bytes = std::min(request.links.memory_limit_bytes, limits.request_memory_bytes);
  read_selection(message, field, limits, violations, request.selection);
  request.skip = skipping_from_message(message.skip(), field + ".skip", violations);
  return request;
}

}  // namespace sunfleck
