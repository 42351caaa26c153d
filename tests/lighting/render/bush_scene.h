// A leafy bush with wood, sun, sky and shade, lit by both ways to a picture.
#pragma once

#include "lighting/trace/reference.h"
#include "sim/base/random.h"
#include "tests/lighting/render/render_scene.h"

namespace sunfleck::test {

inline RenderScene traced_bush() {
  RenderScene scene;
  scene.use_band("PAR");
  scene.override_leaf({0.12, 0.10, 0.06, 0.05}, 0.3);
  RandomStream random(9, 0, RandomPurpose::kTestScene);
  for (int i = 0; i < 500; ++i) {
    const auto number = [&](double lo, double hi) { return static_cast<float>(random.uniform(lo, hi)); };
    scene.leaves().push_back(
        parallelogram({number(-2, 2), number(-2, 2), number(1, 5)}, {0.1f, 0, 0.05f}, {0, 0.1f, 0}));
  }
  scene.wood() = {{{0, 0, 0}, {0, 0, 4}, 0.2f, 0.1f, 0}};
  scene.light.to_sun = glm::normalize(Vec3(1, -1, 2));
  scene.light.sun_half_angle_rad = 0.0046;
  scene.light.bands = {{300.0, 100.0}};
  return scene;
}

inline Camera bush_view(int samples_per_pixel) {
  Camera camera;
  camera.position_m = {0, -10, 4};
  camera.look_at_m = {0, 0, 3};
  camera.width_px = 48;
  camera.height_px = 32;
  camera.samples_per_pixel = samples_per_pixel;
  return camera;
}

inline LightMap reference_map(const RenderScene& scene) {
  ReferenceOptions options;
  options.rays_per_face = 64;
  options.sun_rays_per_element = 32;
  return reference_light_map(scene.forest, OpticsTable(scene.forest, scene.optics_request), scene.light,
                             options, {});
}

inline Image rendered(const RenderScene& scene, const LightMap& map, const Camera& camera) {
  return render(scene.forest, OpticsTable(scene.forest, scene.optics_request), map,
                {camera, scene.light, scene.look, scene.effort, LeafSun::kTraced}, {});
}

inline double grey_at(const Image& image, std::size_t pixel) {
  return (static_cast<double>(image.rgb[3 * pixel]) + image.rgb[3 * pixel + 1] + image.rgb[3 * pixel + 2]) /
         3.0;
}
inline double mean_grey(const Image& image) {
  double sum = 0;
  for (std::size_t p = 0; p < image.depth_m.size(); ++p) sum += grey_at(image, p);
  return sum / static_cast<double>(image.depth_m.size());
}

}  // namespace sunfleck::test
