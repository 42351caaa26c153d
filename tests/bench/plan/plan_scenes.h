// The two scenes that `auto` is judged on, PAR, sun and uniform sky.
#pragma once

#include <cstdint>

#include "lighting/plan/light_request.h"
#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {

inline Forest clumped_crown(int leaves = 40000) {
  Forest forest = generated_crown({.kind = CrownKind::kClumped, .leaves = leaves, .crown_lai = 5, .seed = 3});
  forest.name = "clumped crown";
  return forest;
}

// A hectare: 7 x 7 clumped crowns of 10,000 leaves, about 10 m wide, jittered, turned and scaled.
inline Forest hectare() {
  Forest forest = generated_crown(
      {.kind = CrownKind::kClumped, .leaves = 10000, .radius_m = 5, .crown_lai = 5, .seed = 8});
  forest.instances.clear();
  for (std::uint32_t i = 0; i < 49; ++i) {
    RandomStream random(21, i, RandomPurpose::kTestScene);
    Instance tree;
    tree.position_m = {100.0 / 7 * (i % 7) + random.uniform(-3, 3),
                       100.0 / 7 * (i / 7) + random.uniform(-3, 3), 0};
    tree.yaw_rad = static_cast<float>(random.uniform(0, 6));
    tree.scale = static_cast<float>(random.uniform(0.8, 1.3));
    tree.tree = TreeId{i + 1};
    forest.instances.push_back(tree);
  }
  forest.name = "hectare";
  return forest;
}

inline LightRequest par_request(Method method) {
  LightRequest r;
  r.method = method;
  r.optics = {{"PAR"}, {0.1}, {}};
  r.light.to_sun = direction_from_azimuth_zenith(radians_from_degrees(150), radians_from_degrees(35));
  r.light.sun_half_angle_rad = radians_from_degrees(0.265);
  r.light.bands = {{400 / r.light.to_sun.z, 100}};
  return r;
}

}  // namespace sunfleck
