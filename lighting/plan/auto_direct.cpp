#include "lighting/plan/auto_direct.h"

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

}  // namespace sunfleck
