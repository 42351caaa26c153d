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

void refuse_what_does_not_fit(const GridSuitability& s, const GridOptions& options) {
  if (s.fits) return;
  std::ostringstream problem, remedy;
  problem << "cells of " << options.cell_m << " m need " << s.bytes << " bytes (" << s.cells
          << " cells); the limit is " << options.memory_limit_bytes;
  remedy << "at least " << s.smallest_cell_m
         << " m, 0 to have it chosen, or a higher grid.memory_limit_bytes";
  throw Error(ErrorKind::kLimitExceeded, "grid.cell_m", problem.str(), remedy.str());
}

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

}  // namespace

GridPrepared prepare_grid(const Forest& forest, const GridOptions& options, const RunControl& control) {
  check_grid_options(options);
  validate(forest);
  const ForestIndex index(forest);
  if (index.element_count() == 0)
    throw_invalid("forest", "it has no foliage element, so there is nothing to compute light for",
                  "give a forest with at least one tree that has leaves or shoots");
  refuse_what_does_not_fit(grid_suitability(forest, options), options);
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
  const TransportScene& scene = *prepared.scene;
  const Illumination checked_light = checked(light, light.bands.size());
  GridSources sources = before;
  if (!checked_light.sun_is_up() || !any(light, &BandLight::beam_normal_w_m2)) {
    sources.sun.reset();
  } else if (!before.sun || before.sun->to_sun != checked_light.to_sun) {
    sources.sun = std::make_shared<const GridSun>(
        GridSun{checked_light.to_sun, direct_sun(scene, forest, checked_light.to_sun, control)});
  }
  const bool needed = any(light, &BandLight::diffuse_horizontal_w_m2);
  if (before.sky && before.sky->key == sky_key(light) && (before.sky->swept || !needed)) return sources;
  GridSky sky{.key = sky_key(light),
              .sectors = sky_sectors(scene.set, sky_radiance(light), forest.terrain.normal()),
              .swept = needed,
              .radiance = {},
              .on_elements = {}};
  if (needed) {
    sky.radiance = sky_radiance(scene, sky.sectors, control);
    sky.on_elements = gather(scene, sky.radiance, {}, control);
  } else {
    sky.radiance.assign(scene.set.count() * scene.cells(), 0.0f);
    sky.on_elements.resize(scene.field->elements().size());
  }
  sources.sky = std::make_shared<const GridSky>(std::move(sky));
  return sources;
}

}  // namespace sunfleck
