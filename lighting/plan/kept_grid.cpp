#include "lighting/plan/kept_grid.h"

#include <utility>

#include "lighting/base/summaries.h"
#include "lighting/transport/grid_limits.h"
#include "lighting/transport/transport_scene.h"

namespace sunfleck {
namespace {

PreparedKey grid_key(std::string_view what, const GridOptions& o) {
  return PreparedKey(what)
      .add("directions", o.directions)
      .add("cell_m", o.cell_m)
      .add("memory", o.memory_limit_bytes);
}

std::uint64_t bytes_of(const GridPrepared& prepared, std::uint64_t elements) {
  return grid_bytes(prepared.scene->cells(), elements, static_cast<int>(prepared.scene->set.count()));
}

// Of one source alone: the other's strengths are taken away, so that its part is not made.
GridSources kept_sources(const LightScene& scene, PreparedKey key, Illumination light,
                         double BandLight::*other, const GridPrepared& prepared, std::uint64_t bytes,
                         const RunControl& control) {
  for (BandLight& band : light.bands) band.*other = 0.0;
  return *scene.store.get<GridSources>(
      key, control,
      [&] {
        return std::make_shared<const GridSources>(grid_sources(scene.forest, light, prepared, {}, control));
      },
      [&](const GridSources&) { return bytes; });
}

bool any(const Illumination& light, double BandLight::*strength) {
  for (const BandLight& band : light.bands)
    if (band.*strength > 0.0) return true;
  return false;
}

}  // namespace

LightMap kept_grid_light_map(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
                             const GridOptions& options, std::span<const float> sunlit_fraction,
                             const RunControl& control) {
  Provenance before;
  const std::uint64_t elements = scene.index.element_count();
  std::shared_ptr<const GridPrepared> prepared;
  {
    const StageTimer timer(before, "leaf-area grid");
    prepared = scene.store.get<GridPrepared>(
        grid_key("grid", options), control,
        [&] { return std::make_shared<const GridPrepared>(prepare_grid(scene.forest, options, control)); },
        [&](const GridPrepared& made) { return bytes_of(made, elements); });
  }
  GridSources sources;
  if (light.sun_is_up() && any(light, &BandLight::beam_normal_w_m2)) {
    const StageTimer timer(before, "sun");
    if (!sunlit_fraction.empty()) {
      Illumination sun_alone = light;
      for (BandLight& band : sun_alone.bands) band.diffuse_horizontal_w_m2 = 0.0;
      sources.sun = grid_sources(scene.forest, sun_alone, *prepared, sunlit_fraction, {}, control).sun;
    } else {
      sources.sun = kept_sources(scene, grid_key("grid sun", options).add("to_sun", light.to_sun), light,
                                 &BandLight::diffuse_horizontal_w_m2, *prepared, 16 * elements, control)
                        .sun;
    }
  }
  {
    const StageTimer timer(before, "sky sweeps");
    const bool none = !any(light, &BandLight::diffuse_horizontal_w_m2);
    sources.sky =
        kept_sources(scene, grid_key("grid sky", options).add("sky", none ? "none" : sky_key(light)), light,
                     &BandLight::beam_normal_w_m2, *prepared, bytes_of(*prepared, elements) / 2, control)
            .sky;
  }
  LightMap map = grid_light_map(scene.forest, optics, light, options, *prepared, sources, control);
  auto& times = map.provenance.times;
  times.insert(times.begin(), before.times.begin(), before.times.end());
  return map;
}

}  // namespace sunfleck
