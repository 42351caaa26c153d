// [SPP] Fig. 9, steps 1 to 3; see spp_estimators.h.
#include "lighting/slab/spp_prepare.h"

#include <cmath>

#include "lighting/slab/sky_light.h"
#include "lighting/slab/spp_marched.h"
#include "sim/base/error.h"

namespace sunfleck {

void check_options(const SppOptions& o) {
  if (o.sample_directions != 16 && o.sample_directions != 22)
    throw_invalid("spp.sample_directions", "is " + std::to_string(o.sample_directions), "16 or 22");
  if (o.map_resolution < 8 || o.map_resolution > 1024)
    throw_invalid("spp.map_resolution", "is " + std::to_string(o.map_resolution), "8 to 1024 texels");
  if (o.grid_resolution < 2 || o.grid_resolution > 64)
    throw_invalid("spp.grid_resolution", "is " + std::to_string(o.grid_resolution), "2 to 64 cells");
  if (!(std::isfinite(o.marched.cell_m) && o.marched.cell_m >= 0.0))
    throw_invalid("spp.marched.cell_m", "is not a length >= 0", "0 for 2 to 4 leaf sides, or metres");
}

std::string method_name(SppVariant variant) {
  switch (variant) {
    case SppVariant::kSingleScattering:
      return "single_scattering";
    case SppVariant::kSpp:
      return "spp";
    case SppVariant::kSppH:
      return "spp_h";
    case SppVariant::kSppMarched:
      return "spp_marched";
    case SppVariant::kSppG:
      break;
  }
  return "spp_g";
}

SppPrepared prepare_spp_cells(const Forest& forest, const SppOptions& options) {
  check_options(options);
  ForestGrids grids;
  if (options.variant != SppVariant::kSppMarched) grids = make_forest_grids(forest, options.grid_resolution);
  CellDepths none{SampleDirections(options.sample_directions, 0.0), 0, {}, {}, {}, true};
  return {options, std::move(grids), std::move(none), {}, CanopyAngles(forest), nullptr};
}

void prepare_spp_depths(const Forest& forest, SppPrepared& prepared, const RunControl& control) {
  const SppOptions& o = prepared.options;
  if (o.variant == SppVariant::kSppMarched) return prepare_marched_depths(forest, prepared, control);
  const int resolution = std::min(o.map_resolution, 2 * o.grid_resolution);
  prepared.cells = measure_cell_depths(forest, prepared.grids, o.sample_directions, resolution, control);
}

void prepare_spp_compensation(SppPrepared& prepared, const RunControl& control) {
  if (prepared.options.variant == SppVariant::kSppG)
    prepared.compensation = sky_compensation(prepared.cells, control);
}

SppPrepared prepare_spp(const Forest& forest, const SppOptions& options, const RunControl& control) {
  SppPrepared prepared = prepare_spp_cells(forest, options);
  prepare_spp_depths(forest, prepared, control);
  prepare_spp_compensation(prepared, control);
  return prepared;
}

}  // namespace sunfleck
