#include "lighting/plan/kept_methods.h"

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include "lighting/base/summaries.h"
#include "lighting/envelope/envelope_full.h"
#include "lighting/plan/auto_direct.h"
#include "lighting/trace/probe_path.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

void add_times(LightMap& map, const std::vector<StageTime>& before) {
  map.provenance.times.insert(map.provenance.times.begin(), before.begin(), before.end());
}

PreparedKey spp_key(const SppOptions& o) {
  return PreparedKey("spp")
      .add("variant", static_cast<int>(o.variant))
      .add("sample_directions", o.sample_directions)
      .add("map_resolution", o.map_resolution)
      .add("grid_resolution", o.grid_resolution)
      .add("phase", static_cast<int>(o.marched.phase))
      .add("paths", static_cast<int>(o.marched.paths))
      .add("cell_m", o.marched.cell_m);
}

PreparedKey envelope_key(const EnvelopeFullOptions& o) {
  return PreparedKey("envelope_full")
      .add("directions", o.directions)
      .add("sun", static_cast<int>(o.sun))
      .add("angles", static_cast<int>(o.angles))
      .add("bounces", static_cast<int>(o.bounces))
      .add("ground", static_cast<int>(o.ground))
      .add("weights", static_cast<int>(o.weights))
      .add("own_leaf", static_cast<int>(o.own_leaf))
      .add("border", static_cast<int>(o.border))
      .add("cell_m", o.cell_m);
}

PreparedKey sectors_key(const EnvelopeOptions& o) {
  return PreparedKey("envelope sectors").add("cell_m", o.cell_m);
}

PreparedKey links_key(std::string_view what, const LinksOptions& o) {
  return PreparedKey(what)
      .add("seed", o.seed)
      .add("links_per_face", o.links_per_face)
      .add("ground", o.ground ? 1 : 0)
      .add("ground_cell_m", o.ground_cell_m);
}

PreparedKey world_key(const WorldOptions& o) {
  return PreparedKey("world")
      .add("directions", o.directions)
      .add("cell_m", o.cell_m)
      .add("memory", o.memory_limit_bytes);
}

std::shared_ptr<const links::DirectLight> kept_links_sun(const LightScene& scene,
                                                         const LinksPrepared& prepared,
                                                         const Illumination& light,
                                                         const LinksOptions& options,
                                                         const RunControl& control) {
  return scene.store.get<links::DirectLight>(
      links_key("links sun", options)
          .add("to_sun", light.to_sun)
          .add("half_angle", light.sun_half_angle_rad)
          .add("sun_rays", options.sun_rays_per_element),
      control,
      [&] {
        const auto drawn =
            sun_exposure(scene, light, {.ground = options.ground, .seed = options.seed}, control);
        return std::make_shared<const links::DirectLight>(
            links_given_light(prepared, light, options, drawn->sunlit_fraction, control));
      },
      [](const links::DirectLight& d) {
        return (d.on_face.size() + d.sunlit_fraction.size()) * sizeof(float) + sizeof d;
      });
}

// What a method keeps with the forest, made once and timed as a stage of the answer that needed it first.
template <class Prepared, class Key, class Make, class Bytes>
std::shared_ptr<const Prepared> kept(const LightScene& scene, const char* stage, const Key& key,
                                     Provenance& before, const RunControl& control, const Make& make,
                                     const Bytes& bytes) {
  const StageTimer timer(before, stage);
  return scene.store.get<Prepared>(
      key, control, [&] { return std::make_shared<const Prepared>(make()); }, bytes);
}

}  // namespace

LightMap kept_spp_light_map(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
                            const SppOptions& options, const RunControl& control) {
  Provenance before;
  const auto prepared = kept<SppPrepared>(
      scene, "preprocess", spp_key(options), before, control,
      [&] { return prepare_spp(scene.forest, options, control); },
      [&](const SppPrepared&) {  // depths of cells in all directions, and the leaf-area grid where marched
        return 64 * static_cast<std::uint64_t>(scene.index.element_count()) +
               sizeof(float) * 96ull * 4096 * scene.forest.instances.size();
      });
  LightMap map = spp_light_map(scene.forest, optics, light, *prepared, control);
  add_times(map, before.times);
  return map;
}

LightMap kept_envelope_light_map(const LightScene& scene, const OpticsTable& optics,
                                 const Illumination& light, const EnvelopeFullOptions& options,
                                 const RunControl& control) {
  Provenance before;
  const auto prepared = kept<EnvelopePrepared>(
      scene, "sector depths", envelope_key(options), before, control,
      [&] { return prepare_envelope(scene.forest, options, control); },
      [](const EnvelopePrepared& p) { return static_cast<std::uint64_t>(p.memory_bytes()); });
  LightMap map = envelope_full_light_map(scene.forest, optics, light, *prepared, control);
  add_times(map, before.times);
  return map;
}

LightMap kept_envelope_light_map(const LightScene& scene, const OpticsTable& optics,
                                 const Illumination& light, const EnvelopeOptions& options,
                                 const RunControl& control) {
  Provenance before;
  const auto sectors = kept<EnvelopeSectors>(
      scene, "sector depths", sectors_key(options), before, control,
      [&] { return prepare_envelope_sectors(scene.forest, options, control); },
      [](const EnvelopeSectors& s) { return s.bytes(); });
  LightMap map = envelope_light_map(scene.forest, optics, light, options, *sectors, control);
  add_times(map, before.times);
  return map;
}

LightMap kept_links_light_map(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
                              const LinksOptions& options, std::span<const float> sunlit_fraction,
                              const RunControl& control) {
  Provenance before;
  const auto prepared = kept<LinksPrepared>(
      scene, "tracing links", links_key("links", options), before, control,
      [&] { return prepare_links(scene.forest, options, control); },
      [](const LinksPrepared& p) { return p.bytes(); });
  std::shared_ptr<const links::DirectLight> sun;
  {
    const StageTimer timer(before, "tracing sun");
    if (!trace::has_beam(light))
      sun =
          std::make_shared<const links::DirectLight>(links_direct_light(*prepared, light, options, control));
    else if (sunlit_fraction.empty())
      sun = kept_links_sun(scene, *prepared, light, options, control);
    else
      sun = std::make_shared<const links::DirectLight>(
          links_given_light(*prepared, light, options, sunlit_fraction, control));
  }
  LightMap map = links_light_map(scene.forest, optics, light, options, *prepared, *sun, control);
  add_times(map, before.times);
  return map;
}

LightMap kept_world_light_map(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
                              const WorldOptions& options, const std::vector<std::uint32_t>& instances,
                              const RunControl& control) {
  Provenance before;
  const auto prepared = kept<WorldPrepared>(
      scene, "world preparation", world_key(options), before, control,
      [&] { return prepare_world(scene.forest, options, control); },
      [&](const WorldPrepared&) { return options.memory_limit_bytes; });
  LightMap map;
  const WorldLight world = world_light(scene.forest, optics, light, options, *prepared, control);
  {
    const StageTimer timer(before, "trees");
    std::vector<LightMap> trees(instances.size());
    const RunControl stop_only{control.stop, {}};
    for (std::size_t k = 0; k < instances.size(); ++k) {
      trees[k] = tree_light(scene.forest, optics, world, instances[k], options, stop_only);
      control.report("trees", static_cast<double>(k + 1) / static_cast<double>(instances.size()));
    }
    map.bands.resize(world.bands.size());
    for (std::size_t b = 0; b < map.bands.size(); ++b) map.bands[b].band = world.bands[b].band;
    for (const LightMap& tree : trees) {
      map.sunlit_fraction.insert(map.sunlit_fraction.end(), tree.sunlit_fraction.begin(),
                                 tree.sunlit_fraction.end());
      for (std::size_t b = 0; b < map.bands.size(); ++b)
        map.bands[b].elements.insert(map.bands[b].elements.end(), tree.bands[b].elements.begin(),
                                     tree.bands[b].elements.end());
    }
  }
  map.provenance.times = before.times;
  map.provenance.times.insert(map.provenance.times.end(), world.times.begin(), world.times.end());
  map.provenance.notes = prepared->notes;
  map.provenance.settings = {{"world.directions", std::to_string(options.directions)}};
  return map;
}

}  // namespace sunfleck
