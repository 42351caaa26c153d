#include "lighting/plan/auto_direct.h"

#include "lighting/trace/probe_sun.h"
#include "lighting/trace/surface_sampler.h"
#include "sim/base/contract.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"

namespace sunfleck {

void trace_direct(const ProbeScene& scene, const Illumination& light, int rays, std::uint64_t seed,
                  LightMap& map, const RunControl& control) {
  using namespace trace;
  SUNFLECK_EXPECTS(rays > 0 && map.sunlit_fraction.size() == scene.receivers().foliage_count());
  const std::vector<std::uint32_t>& order = scene.order();  // foliage first
  for_each_chunk(map.sunlit_fraction.size(), 64, control, "tracing sun", [&](std::size_t b, std::size_t e) {
    for (std::size_t i = b; i < e; ++i) {
      const std::uint32_t element = order[i];
      if (static_cast<int>(i - b) * rays % 512 < rays) control.check();
      RandomStream random(seed, element, RandomPurpose::kSunRays);
      const SunOnSurface sun = sun_on_surface(scene.rays(), SurfaceSampler(scene.receivers(), element), light,
                                              rays, SunPoints::kSpread, random);
      map.sunlit_fraction[element] = static_cast<float>(sun.seen);
      for (std::size_t band = 0; band < map.bands.size(); ++band) {
        const double beam = light.bands[band].beam_normal_w_m2;
        map.bands[band].elements[element].front.direct_w_m2 = static_cast<float>(beam * sun.front);
        map.bands[band].elements[element].back.direct_w_m2 = static_cast<float>(beam * sun.back);
      }
    }
  });
}

}  // namespace sunfleck
