#include "lighting/links/direct_light.h"

#include "lighting/trace/probe_path.h"
#include "lighting/trace/probe_sun.h"
#include "lighting/trace/visiting_order.h"
#include "sim/base/parallel.h"

namespace sunfleck::links {

DirectLight direct_light_by_rays(const trace::Receivers& receivers, const RayScene& scene,
                                 const Illumination& light, int rays_per_surface, std::uint64_t seed,
                                 const RunControl& control) {
  DirectLight direct;
  direct.on_face.resize(receivers.face_count());
  direct.sunlit_fraction.resize(receivers.foliage_count());
  if (!trace::has_beam(light)) return direct;
  const std::vector<std::uint32_t> order = trace::visiting_order(receivers);
  for_each_chunk(order.size(), 32, control, "tracing sun", [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      control.check();
      const std::uint32_t s = order[i];
      const trace::SurfaceSampler surface(receivers, s);
      RandomStream random(seed, s, RandomPurpose::kSunRays);
      const trace::SunOnSurface sun =
          trace::sun_on_surface(scene, surface, light, rays_per_surface, trace::SunPoints::kSpread, random);
      const std::size_t face = receivers.first_face(s);
      direct.on_face[face] = static_cast<float>(sun.front);
      if (receivers.faces_of(s) == 2) direct.on_face[face + 1] = static_cast<float>(sun.back);
      if (s < direct.sunlit_fraction.size()) direct.sunlit_fraction[s] = static_cast<float>(sun.seen);
    }
  });
  return direct;
}

}  // namespace sunfleck::links
