// The parts of GridSources: see grid_estimator.h.
#pragma once

#include <string>

#include "lighting/transport/direct_sun.h"
#include "lighting/transport/transport_scene.h"

namespace sunfleck::transport {

struct GridSun {
  Vec3 to_sun{0, 0, 1};
  bool given = false;  // the elements' light was known before
  DirectSun light;
};

struct GridSky {
  std::string key;  // sky_key() of its light
  SkySectors sectors;
  bool swept = false;                 // false: nothing but the sectors
  std::vector<float> radiance;        // sky_radiance(); zeros if not swept
  std::vector<FacePair> on_elements;  // irradiance for a diffuse irradiance of 1
};

}  // namespace sunfleck::transport
