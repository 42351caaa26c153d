#include "lighting/trace/sun_light.h"

#include <algorithm>
#include <cmath>

#include "lighting/trace/surface_sampler.h"
#include "sim/base/parallel.h"

namespace sunfleck::trace {
namespace {

// Casts one shadow ray and adds its light to the face it falls on.
void cast(SunLight& sun, const SurfaceSampler& surface, std::size_t s, int k, const RayScene& scene,
          const Receivers& receivers, const Illumination& light, const FacePoints& points) {
  const CubePoint x = points(k);
  const SurfacePoint at = surface.sample_at(x[0], x[1], x[2]);
  const Vec3 to_sun = cone_direction(light.to_sun, light.sun_half_angle_rad, x[3], x[4]);
  const double cosine = glm::dot(at.normal, to_sun);
  if (scene.occluded(at.position_m, to_sun, 0.0, surface.start(at, cosine >= 0.0))) return;
  ++sun.visible[s];
  // The disc's mean cosine to its own axis is (1 + cos half_angle) / 2.
  const double facing = 2.0 / (1.0 + std::cos(light.sun_half_angle_rad));
  const std::size_t face = receivers.first_face(s), group = group_of(s, k);
  if (surface.is_shoot()) {  // normals point everywhere alike: mean of max(0, cosine) is 1/4 on each face
    sun.received[face][group] += 0.25f;
    sun.received[face + 1][group] += 0.25f;
  } else if (cosine > 0.0) {
    sun.received[face][group] += static_cast<float>(facing * cosine);
  } else if (cosine < 0.0 && receivers.faces_of(s) == 2) {
    sun.received[face + 1][group] -= static_cast<float>(facing * cosine);
  }
}

}  // namespace

void extend(SunLight& sun, int rays, const RayScene& scene, const Receivers& receivers,
            std::span<const std::uint32_t> order, const Illumination& light, std::uint64_t seed,
            const RunControl& control) {
  const int before = sun.rays;
  if (rays <= before) return;
  sun.received.resize(receivers.face_count());
  sun.visible.resize(receivers.surface_count());
  sun.rays = rays;
  for_each_chunk(order.size(), 32, control, "tracing sun", [&](std::size_t b, std::size_t e) {
    for (const std::uint32_t s : order.subspan(b, e - b)) {
      const SurfaceSampler surface(receivers, s);
      const FacePoints points(mix_seed(seed, static_cast<std::uint64_t>(RandomPurpose::kSunRays)), s);
      for (int k = before; k < rays; ++k) {
        if (k % 64 == 0) control.check();
        cast(sun, surface, s, k, scene, receivers, light, points);
      }
    }
  });
}

}  // namespace sunfleck::trace
