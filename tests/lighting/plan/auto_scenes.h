// Scenes whose error bars are tested, small enough for an exact truth.
#pragma once

#include <vector>

#include "lighting/plan/light_request.h"
#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck::test {

// Nine crowns of two kinds and several sizes on bright ground.
inline Forest small_stand() {
  Forest forest = generated_crown({.kind = CrownKind::kClumped, .leaves = 400, .crown_lai = 3, .seed = 5});
  forest.instances.clear();
  for (std::uint32_t i = 0; i < 9; ++i) {
    RandomStream random(21, i, RandomPurpose::kTestScene);
    Instance tree;
    tree.position_m = {2.2 * (i % 3) + random.uniform(-0.3, 0.3), 2.2 * (i / 3) + random.uniform(-0.3, 0.3),
                       0};
    tree.yaw_rad = static_cast<float>(random.uniform(0, 6));
    tree.scale = static_cast<float>(random.uniform(0.6, 1.4));
    forest.instances.push_back(tree);
  }
  forest.name = "stand";
  return forest;
}

inline std::vector<Forest> scenes_for_error_bars() {
  return {generated_crown({.kind = CrownKind::kSphere, .leaves = 1500, .crown_lai = 4, .seed = 11}),
          generated_crown({.kind = CrownKind::kClumped, .leaves = 1500, .crown_lai = 4, .seed = 12}),
          generated_layer({.lai = 3, .leaves = 1200, .seed = 13}), small_stand()};
}

inline LightRequest sun_and_sky(Method method) {
  LightRequest r;
  r.method = method;
  r.optics = {{"PAR", "NIR"}, {0.1, 0.3}, {}};
  r.light.to_sun = direction_from_azimuth_zenith(1.0, 0.6);
  r.light.sun_half_angle_rad = radians_from_degrees(0.265);
  r.light.bands = {{400, 100}, {300, 80}};
  return r;
}

}  // namespace sunfleck::test
