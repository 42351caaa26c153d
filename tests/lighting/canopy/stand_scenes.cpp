#include "tests/lighting/canopy/stand_scenes.h"

#include <algorithm>
#include <cmath>

namespace sunfleck::test {

LightSource sky_source(SkyModel model, int rings) {
  LightSource source;
  std::vector<double> strength;
  double horizontal = 0.0;
  const double step = 1.0 / rings;
  for (int ring = 0; ring < rings; ++ring) {
    const double z = 1.0 - (ring + 0.5) * step;
    const int count = std::max(4, static_cast<int>(2.0 * kPi * std::sqrt(1.0 - z * z) / std::sqrt(step)));
    const double solid_angle = 2.0 * kPi * step / count;
    for (int k = 0; k < count; ++k) {
      source.to_source.push_back(direction_from_azimuth_zenith(2.0 * kPi * (k + 0.5) / count, std::acos(z)));
      source.half_angle_rad.push_back(cone_half_angle_rad(solid_angle));
      strength.push_back(relative_sky_radiance(model, z) * solid_angle);
      horizontal += strength.back() * z;
    }
  }
  for (std::size_t d = 0; d < strength.size(); ++d) source.strength.add(d, strength[d] / horizontal);
  source.strength.end_row();
  return source;
}

LightSource sun_source(const Vec3& to_sun, double strength) {
  LightSource source;
  source.to_source = {glm::normalize(to_sun)};
  source.strength.add(0, strength);
  source.strength.end_row();
  return source;
}

LightSource dark_source() {
  LightSource source;
  source.strength.end_row();
  return source;
}

StandSky stand_sky(LightSource sun, LightSource sky) { return {std::move(sun), std::move(sky), {"day"}}; }

Forest small_stand(bool periodic) {
  Forest forest =
      forest_of(random_leaves(Crown::kSphere, {0, 0, 1.2}, Vec3(0.5), 300, 0.12, 5), {Leaf{0.1, 0.05, 0.2}});
  forest.prototypes[0].wood.push_back({{0, 0, 0}, {0, 0, 1.2f}, 0.05f, 0.02f, 0});
  forest.instances.clear();
  for (int i = 0; i < 3; ++i) {
    Instance tree;
    tree.position_m = {0.4 + 0.6 * i, 0.5 + 0.4 * (i % 2), 0};
    tree.yaw_rad = static_cast<float>(i);
    tree.scale = 0.8f + 0.15f * static_cast<float>(i);
    tree.tree.value = static_cast<std::uint32_t>(100 + i);
    forest.instances.push_back(tree);
  }
  if (periodic) forest.period = Period{{0, 0}, {2, 2}};
  return forest;
}

}  // namespace sunfleck::test
