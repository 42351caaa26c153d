// See world_light.h.
#include "lighting/transport/world_light.h"

#include <cmath>
#include <sstream>

#include "lighting/base/summaries.h"
#include "lighting/transport/grid_limits.h"
#include "lighting/transport/world_solver.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"

namespace sunfleck {

namespace {

using namespace transport;

std::string number(double value) {
  std::ostringstream out;
  out.precision(4);
  out << value;
  return out.str();
}

void check_world_options(const WorldOptions& o) {
  if (o.directions != 8 && o.directions != 14 && o.directions != 26)
    throw_invalid("world.directions", std::to_string(o.directions) + " directions are not built",
                  "8, 14 or 26");
  if (!(o.cell_m >= 0.0 && std::isfinite(o.cell_m)))
    throw_invalid("world.cell_m", "a cell cannot be " + number(o.cell_m) + " m",
                  "a length in metres, 0.3 to 1 is usual, or 0 to have it chosen");
  if (o.memory_limit_bytes < (1ull << 20))
    throw_invalid("world.memory_limit_bytes", std::to_string(o.memory_limit_bytes) + " bytes hold no grid",
                  "at least 1048576; 1073741824 is usual");
  if (!(o.convergence > 0.0 && o.convergence <= 0.5))
    throw_invalid("world.convergence", number(o.convergence) + " is out of range",
                  "more than 0, at most 0.5; 0.002 is usual");
  if (o.max_iterations < 1 || o.max_iterations > 10000)
    throw_invalid("world.max_iterations", std::to_string(o.max_iterations) + " is out of range",
                  "1 to 10000");
}

// The cell to use: as asked for or by the rule, coarser to fit unless it was asked for.
GridLayout fitting_layout(const Forest& forest, const WorldOptions& options) {
  const GridFrame frame = grid_frame(forest);
  const Box box = world_box(forest, frame);
  const std::uint64_t most =
      std::max<std::uint64_t>(27, options.memory_limit_bytes / world_bytes_per_cell(options.directions));
  const double cell = options.cell_m > 0.0 ? options.cell_m : world_cell_size(forest);
  const GridLayout layout = fit_grid(box, frame.period_box(), cell, std::min<std::uint64_t>(most, 1u << 31));
  if (options.cell_m > 0.0 && layout.coarsened) {
    const Vec3 size = box.size();
    const double cells = (size.x / cell + 3) * (size.y / cell + 3) * (size.z / cell + 3);
    throw Error(ErrorKind::kLimitExceeded, "world.cell_m",
                "cells of " + number(cell) + " m need " +
                    number(cells * static_cast<double>(world_bytes_per_cell(options.directions))) +
                    " bytes; the limit is " + std::to_string(options.memory_limit_bytes),
                "at least " + number(1.005 * layout.mean_cell_m()) +
                    " m, 0 to have it chosen, or a higher world.memory_limit_bytes");
  }
  return layout;
}

std::vector<std::string> world_notes(const Forest& forest, const WorldScene& scene, bool coarsened) {
  std::vector<std::string> notes;
  const double cell = scene.layout.mean_cell_m();
  notes.push_back("world cells of " + number(cell) + " m" +
                  (coarsened ? ": smaller ones would not fit the memory limit" : ""));
  if (cell < 2.0 * scene.leaf_side_m)
    notes.push_back(
        "world cells are smaller than 2 leaf sides: shade between trees may be wrong by some "
        "percent");
  std::size_t few = 0;
  for (const Prototype& p : forest.prototypes) few += !p.foliage.empty() && p.foliage.size() < kFewElements;
  if (few > 0)
    notes.push_back(std::to_string(few) + " prototypes have fewer than " + std::to_string(kFewElements) +
                    " elements: too few for a random medium, light may be wrong by 10 % and more");
  return notes;
}

}  // namespace

WorldPrepared prepare_world(const Forest& forest, const WorldOptions& options, const RunControl& control) {
  check_world_options(options);
  validate(forest);
  if (ForestIndex(forest).element_count() == 0)
    throw_invalid("forest", "it has no foliage element, so there is nothing to compute light for",
                  "give a forest with at least one tree that has leaves or shoots");
  const GridLayout layout = fitting_layout(forest, options);
  const double cell_m = layout.mean_cell_m();
  Provenance provenance;
  WorldPrepared prepared;
  std::vector<WorldPrototype> prototypes;
  {
    const StageTimer timer(provenance, "prototypes");
    prototypes = world_prototypes(forest, cell_m, control);
  }
  {
    const StageTimer timer(provenance, "world grid");
    WorldScene scene = world_scene(forest, std::move(prototypes), layout,
                                   directions_for(forest, options.directions), control);
    for (const WorldPrototype& p : scene.prototypes)
      scene.leaf_side_m = std::max(scene.leaf_side_m, p.leaf_side_m);
    prepared.notes = world_notes(forest, scene, layout.coarsened);
    prepared.scene = std::make_shared<const WorldScene>(std::move(scene));
  }
  prepared.times = std::move(provenance.times);
  return prepared;
}

WorldLight world_light(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                       const WorldOptions& options, const WorldPrepared& prepared,
                       const RunControl& control) {
  check_world_options(options);
  SUNFLECK_EXPECTS(prepared.scene && prepared.scene->instance_leaf_m2.size() == forest.instances.size());
  const WorldScene& scene = *prepared.scene;
  WorldLight world{.prepared = prepared,
                   .light = checked(light, optics.band_count()),
                   .sources = {},
                   .bands = {},
                   .times = {}};
  Provenance provenance;
  {
    const StageTimer timer(provenance, "sun and sky");
    world.sources = std::make_shared<const WorldSources>(world_sources(scene, forest, world.light, control));
  }
  for (std::size_t b = 0; b < optics.band_count(); ++b) {
    const StageTimer timer(provenance, "sweeps");
    WorldBand& band = world.bands.emplace_back();
    band.band = optics.bands()[b];
    band.kernels = std::make_shared<const WorldKernels>(
        world_kernels(scene.prototypes, scene.set, optics, b, world.light.to_sun, control));
    solve_world_band(scene, forest, *world.sources, world.light.bands[b], optics.soil_albedo(b), options,
                     band, control);
  }
  world.times = std::move(provenance.times);
  return world;
}

}  // namespace sunfleck
