#include "lighting/links/direct_light.h"

#include "lighting/trace/probe_path.h"
#include "lighting/trace/probe_sun.h"
#include "lighting/trace/sun_raster.h"
#include "lighting/trace/visiting_order.h"
#include "sim/base/contract.h"
#include "sim/base/parallel.h"

namespace sunfleck::links {

namespace {

DirectLight dark(const trace::Receivers& receivers) {
  DirectLight direct;
  direct.on_face.resize(receivers.face_count());
  direct.sunlit_fraction.resize(receivers.foliage_count());
  return direct;
}

void cast(const trace::Receivers& receivers, const RayScene& scene, const Illumination& light, int rays,
          std::uint64_t seed, std::size_t s, DirectLight& direct) {
  const trace::SurfaceSampler surface(receivers, s);
  RandomStream random(seed, s, RandomPurpose::kSunRays);
  const trace::SunOnSurface sun =
      trace::sun_on_surface(scene, surface, light, rays, trace::SunPoints::kSpread, random);
  const std::size_t face = receivers.first_face(s);
  direct.on_face[face] = static_cast<float>(sun.front);
  if (receivers.faces_of(s) == 2) direct.on_face[face + 1] = static_cast<float>(sun.back);
  if (s < direct.sunlit_fraction.size()) direct.sunlit_fraction[s] = static_cast<float>(sun.seen);
}

}  // namespace

DirectLight direct_light_by_rays(const trace::Receivers& receivers, const RayScene& scene,
                                 const Illumination& light, int rays_per_surface, std::uint64_t seed,
                                 const RunControl& control) {
  DirectLight direct = dark(receivers);
  if (!trace::has_beam(light)) return direct;
  const std::vector<std::uint32_t> order = trace::visiting_order(receivers);
  for_each_chunk(order.size(), 32, control, "tracing sun", [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      control.check();
      cast(receivers, scene, light, rays_per_surface, seed, order[i], direct);
    }
  });
  return direct;
}

DirectLight direct_light_by_shares(const trace::Receivers& receivers, const RayScene& scene,
                                   const Illumination& light, std::span<const float> sunlit_fraction,
                                   int rays_per_surface, std::uint64_t seed, const RunControl& control) {
  SUNFLECK_EXPECTS(sunlit_fraction.size() == receivers.foliage_count());
  DirectLight direct = dark(receivers);
  if (!trace::has_beam(light)) return direct;
  direct.sunlit_fraction.assign(sunlit_fraction.begin(), sunlit_fraction.end());
  const ForestIndex& index = receivers.index();
  for_each_chunk(receivers.foliage_count(), 8192, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const ForestIndex::Place place = index.place(e);
      const BeamOnFaces beam = beam_on_faces(receivers.forest(), place.instance, place.local, light.to_sun);
      direct.on_face[2 * e] = beam.front * sunlit_fraction[e];
      direct.on_face[2 * e + 1] = beam.back * sunlit_fraction[e];
    }
  });
  const std::size_t first = receivers.foliage_count(), others = receivers.surface_count() - first;
  for_each_chunk(others, 32, control, {}, [&](std::size_t begin, std::size_t end) {
    control.check();
    for (std::size_t i = begin; i < end; ++i)
      cast(receivers, scene, light, rays_per_surface, seed, first + i, direct);
  });
  return direct;
}

}  // namespace sunfleck::links
