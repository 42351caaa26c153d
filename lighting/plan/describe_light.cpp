// The light of a request in words and numbers, for provenance.
#include <cstdio>
#include <set>

#include "lighting/plan/light_request.h"

namespace sunfleck {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

void describe_optics(const Forest& forest, const OpticsTable& optics, std::size_t band, Settings& settings) {
  std::set<std::string> said;
  for (std::size_t p = 0; p < forest.prototypes.size(); ++p)
    for (std::size_t m = 0; m < forest.prototypes[p].materials.size(); ++m) {
      const std::string& name = forest.prototypes[p].materials[m];
      if (!said.insert(name).second) continue;
      const MaterialOptics& o = optics.material(band, PrototypeId{static_cast<std::uint32_t>(p)}, m);
      settings.emplace_back("light." + optics.bands()[band] + ".optics." + name,
                            "leaf reflectance " + number(o.leaf.reflectance_front) + " front, " +
                                number(o.leaf.reflectance_back) + " back; leaf transmittance " +
                                number(o.leaf.transmittance_front) + " front, " +
                                number(o.leaf.transmittance_back) + " back; bark reflectance " +
                                number(o.bark_reflectance));
    }
}

}  // namespace

Settings describe_light(const Forest& forest, const LightRequest& request) {
  const OpticsTable optics(forest, request.optics);
  const Illumination light = checked(request.light, optics.band_count());
  Settings settings = {{"light.sun_zenith_deg", number(degrees_from_radians(zenith_of(light.to_sun)))},
                       {"light.sun_azimuth_deg", number(degrees_from_radians(azimuth_of(light.to_sun)))},
                       {"light.sun_half_angle_deg", number(degrees_from_radians(light.sun_half_angle_rad))},
                       {"light.sky", to_string(light.sky)}};
  if (light.sky == SkyModel::kPerez) {
    settings.emplace_back("light.sky_clearness", number(light.sky_clearness));
    settings.emplace_back("light.sky_brightness", number(light.sky_brightness));
  }
  for (std::size_t b = 0; b < optics.band_count(); ++b) {
    const std::string name = "light." + optics.bands()[b] + ".";
    settings.emplace_back(name + "beam_normal_w_m2", number(light.bands[b].beam_normal_w_m2));
    settings.emplace_back(name + "diffuse_horizontal_w_m2", number(light.bands[b].diffuse_horizontal_w_m2));
    settings.emplace_back(name + "soil_albedo", number(optics.soil_albedo(b)));
    describe_optics(forest, optics, b, settings);
  }
  if (forest.period)
    settings.emplace_back("forest.period_m",
                          number(forest.period->size_m.x) + " x " + number(forest.period->size_m.y));
  settings.emplace_back("forest.slope_deg", number(degrees_from_radians(forest.terrain.slope_rad)));
  settings.emplace_back("forest.downhill_azimuth_deg",
                        number(degrees_from_radians(forest.terrain.aspect_rad)));
  return settings;
}

}  // namespace sunfleck
