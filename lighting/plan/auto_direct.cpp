#include "lighting/plan/auto_direct.h"

#include "sim/base/contract.h"
#include "sim/base/parallel.h"

namespace sunfleck {

std::shared_ptr<const SunExposure> sun_exposure(const LightScene& scene, const Illumination& light,
                                                const SunRasterOptions& options, const RunControl& control) {
  return scene.store.get<SunExposure>(
      PreparedKey("sun exposure")
          .add("to_sun", light.to_sun)
          .add("half_angle", light.sun_half_angle_rad)
          .add("target_error", options.target_error)
          .add("pixel_m", options.pixel_m)
          .add("sun_directions", options.sun_directions)
          .add("ground", options.ground ? 1 : 0)
          .add("seed", options.seed),
      control,
      [&] {
        return std::make_shared<const SunExposure>(
            raster_sun(scene.forest, scene.index, light.to_sun, light.sun_half_angle_rad, options, control));
      },
      [](const SunExposure& e) {
        return (e.sunlit_fraction.size() + e.standard_error.size()) * sizeof(float) + sizeof(SunExposure);
      });
}

void set_direct(const LightScene& scene, const Illumination& light, const SunExposure& exposure,
                LightMap& map, const RunControl& control) {
  SUNFLECK_EXPECTS(exposure.sunlit_fraction.size() == map.sunlit_fraction.size());
  map.sunlit_fraction = exposure.sunlit_fraction;
  for_each_chunk(scene.forest.instances.size(), 1, control, {}, [&](std::size_t i, std::size_t) {
    for (std::size_t e = scene.index.first_element(i); e < scene.index.first_element(i + 1); ++e) {
      if (e % 65536 == 0) control.check();
      const BeamOnFaces beam = beam_on_faces(scene.forest, i, e - scene.index.first_element(i), light.to_sun);
      for (std::size_t b = 0; b < map.bands.size(); ++b) {
        const double lit = light.bands[b].beam_normal_w_m2 * exposure.sunlit_fraction[e];
        map.bands[b].elements[e].front.direct_w_m2 = static_cast<float>(lit * beam.front);
        map.bands[b].elements[e].back.direct_w_m2 = static_cast<float>(lit * beam.back);
      }
    }
  });
  for (BandLightMap& band : map.bands) {
    band.has_budget = false;
    band.budget = {};
  }
}

}  // namespace sunfleck
