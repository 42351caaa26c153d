#include "lighting/links/outer_light.h"

#include "lighting/links/link_ends.h"
#include "sim/base/parallel.h"

namespace sunfleck::links {
namespace {

// Of one face.
struct Outer {
  double sky = 0, beyond = 0;
  Outer operator+(const Outer& o) const { return {sky + o.sky, beyond + o.beyond}; }
};

Outer outer_of(const LobeLinks& links, std::uint32_t ground_beyond, const SkyRadiance& radiance) {
  Outer sum;
  for (const std::uint32_t end : links.sky)  // cosine-distributed: irradiance is pi times the mean radiance
    sum.sky += kPi * radiance.radiance(sky_direction(end));
  for (const std::uint32_t end : links.dark_ground) sum.beyond += end == ground_beyond ? 1.0 : 0.0;
  return {links.per_sky * sum.sky, links.per_hit * sum.beyond};
}

}  // namespace

OuterLight outer_light(const LinkTable& table, const trace::Receivers& receivers,
                       std::span<const SurfaceRange> ranges, const Illumination& light,
                       const RunControl& control) {
  OuterLight outer;
  outer.sky.resize(receivers.face_count());
  outer.beyond.resize(receivers.face_count());
  const SkyRadiance radiance = sky_radiance(light);
  const auto of = [&](const LobeLinks& l) { return outer_of(l, receivers.ground_beyond(), radiance); };
  const auto set = [&](std::size_t face, const Outer& o) {
    outer.sky[face] = static_cast<float>(o.sky);
    outer.beyond[face] = static_cast<float>(o.beyond);
  };
  for_each_chunk(ranges.size(), 1, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r)
      for (std::size_t local = ranges[r].begin; local < ranges[r].end; ++local) {
        const LitSurface s = dark_surface(table, receivers, ranges[r], local);
        if (!s.has_back) {
          set(s.face, of(table.of_ground(local)));
          continue;
        }
        const auto lobe = [&](Lobe l) { return of(table.of_lobe(ranges[r].instance, local, l)); };
        Outer front = lobe(kFrontUp) + lobe(kFrontDown), back = lobe(kBackUp) + lobe(kBackDown);
        if (s.is_shoot) front = back = {0.5 * (front.sky + back.sky), 0.5 * (front.beyond + back.beyond)};
        set(s.face, front);
        set(s.face + 1, back);
      }
  });
  return outer;
}

}  // namespace sunfleck::links
