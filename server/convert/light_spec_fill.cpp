// Light requests to the wire, and their identity.
#include "server/convert/light_selection_message.h"
#include "server/convert/light_spec_message.h"
#include "server/convert/method_options.h"
#include "sim/base/sha256.h"
#include "sunfleck/v1/light.pb.h"

namespace sunfleck {
namespace {

v1::Method message_method(Method method) {
  switch (method) {
    case Method::kReference:
      return v1::METHOD_REFERENCE;
    case Method::kSingleScattering:
      return v1::METHOD_SINGLE_SCATTERING;
    case Method::kSpp:
      return v1::METHOD_SPP;
    case Method::kSppG:
      return v1::METHOD_SPP_G;
    case Method::kEnvelope:
      return v1::METHOD_ENVELOPE;
    case Method::kEnvelopeMarched:
      return v1::METHOD_ENVELOPE_MARCHED;
    case Method::kGrid:
      return v1::METHOD_GRID;
    case Method::kSppH:
      return v1::METHOD_SPP_H;
    case Method::kSppMarched:
      return v1::METHOD_SPP_MARCHED;
    case Method::kEnvelopeFull:
      return v1::METHOD_ENVELOPE_FULL;
    case Method::kLinks:
      return v1::METHOD_LINKS;
    case Method::kWorld:
      return v1::METHOD_WORLD;
    case Method::kAuto:
      return v1::METHOD_AUTO;
  }
  return v1::METHOD_UNSPECIFIED;
}

void fill_bands(const LightRequest& request, v1::LightSpec& message) {
  for (std::size_t b = 0; b < request.optics.bands.size(); ++b) {
    v1::Band& band = *message.add_bands();
    band.set_name(request.optics.bands[b]);
    if (b < request.optics.soil_albedo.size()) band.set_soil_albedo(request.optics.soil_albedo[b]);
    if (b >= request.light.bands.size()) continue;
    band.set_beam_normal_w_m2(request.light.bands[b].beam_normal_w_m2);
    band.set_diffuse_horizontal_w_m2(request.light.bands[b].diffuse_horizontal_w_m2);
  }
  for (const OpticsOverride& from : request.optics.overrides) {
    fill_message(from, *message.add_overrides());
  }
}

}  // namespace

v1::SkyModel message_sky(SkyModel sky) {
  switch (sky) {
    case SkyModel::kUniform:
      return v1::SKY_MODEL_UNIFORM;
    case SkyModel::kStandardOvercast:
      return v1::SKY_MODEL_STANDARD_OVERCAST;
    case SkyModel::kPerez:
      return v1::SKY_MODEL_PEREZ;
  }
  return v1::SKY_MODEL_UNSPECIFIED;
}

void fill_message(const OpticsOverride& from, v1::OpticsOverride& to) {
  to.set_material(from.material);
  to.set_band(from.band);
  to.set_leaf_reflectance_front(from.optics.leaf.reflectance_front);
  to.set_leaf_reflectance_back(from.optics.leaf.reflectance_back);
  to.set_leaf_transmittance_front(from.optics.leaf.transmittance_front);
  to.set_leaf_transmittance_back(from.optics.leaf.transmittance_back);
  to.set_bark_reflectance(from.optics.bark_reflectance);
}

void fill_message(const LightRequest& request, v1::LightSpec& message) {
  message.set_method(message_method(request.method));
  fill_bands(request, message);
  v1::Vector3& to_sun = *message.mutable_direction_to_sun();
  to_sun.set_x(request.light.to_sun.x);
  to_sun.set_y(request.light.to_sun.y);
  to_sun.set_z(request.light.to_sun.z);
  message.set_sun_half_angle_rad(request.light.sun_half_angle_rad);
  message.set_sky(message_sky(request.light.sky));
  message.set_sky_clearness(request.light.sky_clearness);
  message.set_sky_brightness(request.light.sky_brightness);
  fill_method_options(request, message);
  fill_selection(request.selection, message);
  message.set_skip(request.skip == Skipping::kNever ? v1::SKIPPING_NEVER : v1::SKIPPING_AUTO);
}

std::string request_key(const LightRequest& request) {
  v1::LightSpec message;  // no maps in it, so that equal requests have equal bytes
  fill_message(request, message);
  return sha256_hex(message.SerializeAsString());
}

}  // namespace sunfleck
