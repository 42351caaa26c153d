// The pieces of prepare_spp().
#pragma once

#include <string>

#include "lighting/slab/spp_estimators.h"

namespace sunfleck {

void check_options(const SppOptions& options);
std::string method_name(SppVariant variant);

// Cells, but no depths yet.
SppPrepared prepare_spp_cells(const Forest& forest, const SppOptions& options);
void prepare_spp_depths(const Forest& forest, SppPrepared& prepared, const RunControl& control);
// For spp_g with a sky: G of every cell and sky source.
void prepare_spp_compensation(SppPrepared& prepared, const RunControl& control);

}  // namespace sunfleck
