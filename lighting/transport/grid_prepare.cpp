// The two steps of the grid method that come before bands and strengths; see grid_estimator.h.
#include <algorithm>
#include <sstream>

#include "lighting/base/summaries.h"
#include "lighting/transport/element_gather.h"
#include "lighting/transport/grid_estimator.h"
#include "lighting/transport/grid_limits.h"
#include "lighting/transport/grid_notes.h"
#include "lighting/transport/grid_parts.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"

namespace sunfleck {

namespace {

using namespace transport;

BlockerFieldOptions field_options(const Forest& forest, const GridOptions& options, std::size_t elements) {
  const std::uint64_t of_elements = grid_bytes(0, elements, options.directions);
  const std::uint64_t left =
      options.memory_limit_bytes > of_elements ? options.memory_limit_bytes - of_elements : 0;
  return {.cell_m = options.cell_m > 0.0 ? options.cell_m : grid_cell_size(forest),
          .max_cells = std::clamp<std::uint64_t>(left / grid_bytes(1, 0, options.directions), 27, 1ull << 31),
          .keep_cell = options.cell_m > 0.0};
}

bool any(const Illumination& light, double BandLight::*strength) {
  return std::ranges::any_of(light.bands, [&](const BandLight& b) { return b.*strength > 0.0; });
}

bool has_sun(const Illumination& light) {
  return light.sun_is_up() && any(light, &BandLight::beam_normal_w_m2);
}

void check_sunlit_fraction(std::span<const float> sunlit_fraction, std::size_t elements) {
  if (sunlit_fraction.size() != elements)
    throw_invalid("sunlit_fraction",
                  std::to_string(sunlit_fraction.size()) + " values for " + std::to_string(elements) +
                      " foliage elements",
                  "one value per element, in ForestIndex order");
  for (std::size_t e = 0; e < elements; ++e)
    if (!(sunlit_fraction[e] >= 0.0f && sunlit_fraction[e] <= 1.0f))
      throw_invalid("sunlit_fraction",
                    "element " + std::to_string(e) + " has " + std::to_string(sunlit_fraction[e]),
                    "a share from 0 to 1");
}

std::shared_ptr<const GridSun> sun_of(const Forest& forest, const Illumination& light,
                                      const GridPrepared& prepared, std::span<const float> sunlit_fraction,
                                      const RunControl& control) {
  return std::make_shared<const GridSun>(
      GridSun{light.to_sun, !sunlit_fraction.empty(),
              direct_sun(*prepared.scene, forest, light.to_sun, sunlit_fraction, control)});
}

std::shared_ptr<const GridSky> sky_of(const Forest& forest, const Illumination& light,
                                      const GridPrepared& prepared, const GridSources& before,
                                      const RunControl& control) {
  const TransportScene& scene = *prepared.scene;
  const bool needed = any(light, &BandLight::diffuse_horizontal_w_m2);
  if (before.sky && before.sky->key == sky_key(light) && (before.sky->swept || !needed)) return before.sky;
  GridSky sky{.key = sky_key(light),
              .sectors = sky_sectors(scene.set, sky_radiance(light), forest.terrain.normal()),
              .swept = needed,
              .radiance = {},
              .on_elements = {}};
  if (needed) {
    sky.radiance = sky_radiance(scene, sky.sectors, CellValue::kMiddle, control);
    sky.on_elements = gather(scene, sky.radiance, {}, control);
    // For the leaves' first scattering; a period's budget shows.
    if (scene.periodic) sky.radiance = sky_radiance(scene, sky.sectors, CellValue::kMean, control);
  } else {
    sky.radiance.assign(scene.set.count() * scene.cells(), 0.0f);
    sky.on_elements.resize(scene.field->elements().size());
  }
  return std::make_shared<const GridSky>(std::move(sky));
}

}  // namespace

GridPrepared prepare_grid(const Forest& forest, const GridOptions& options, const RunControl& control) {
  check_grid_options(options);
  validate(forest);
  const ForestIndex index(forest);
  if (index.element_count() == 0)
    throw_invalid("forest", "it has no foliage element, so there is nothing to compute light for",
                  "give a forest with at least one tree that has leaves or shoots");
  check_grid_fits(forest, options);
  Provenance provenance;
  GridPrepared prepared;
  control.report("leaf-area grid", 0.0);
  {
    const StageTimer timer(provenance, "leaf-area grid");
    prepared.forest_hash = content_hash(forest);
    TransportScene scene = transport_scene(forest, index, directions_for(forest, options.directions),
                                           field_options(forest, options, index.element_count()), control);
    scene.ground = std::make_unique<GroundMap>(forest, scene.frame, scene.layout, scene.set,
                                               GroundMap::kUsualCellsPerSide, control);
    prepared.scene = std::make_shared<const TransportScene>(std::move(scene));
    prepared.notes = grid_notes(forest, *prepared.scene);
  }
  prepared.times = std::move(provenance.times);
  control.report("leaf-area grid", 1.0);
  return prepared;
}

GridSources grid_sources(const Forest& forest, const Illumination& light, const GridPrepared& prepared,
                         const GridSources& before, const RunControl& control) {
  SUNFLECK_EXPECTS(prepared.scene != nullptr);
  const Illumination good = checked(light, light.bands.size());
  const bool kept = before.sun && !before.sun->given && before.sun->to_sun == good.to_sun;
  return {!has_sun(good) ? nullptr
          : kept         ? before.sun
                         : sun_of(forest, good, prepared, {}, control),
          sky_of(forest, good, prepared, before, control)};
}

GridSources grid_sources(const Forest& forest, const Illumination& light, const GridPrepared& prepared,
                         std::span<const float> sunlit_fraction, const GridSources& before,
                         const RunControl& control) {
  SUNFLECK_EXPECTS(prepared.scene != nullptr);
  check_sunlit_fraction(sunlit_fraction, prepared.scene->field->elements().size());
  const Illumination good = checked(light, light.bands.size());
  return {has_sun(good) ? sun_of(forest, good, prepared, sunlit_fraction, control) : nullptr,
          sky_of(forest, good, prepared, before, control)};
}

}  // namespace sunfleck
