// Light maps as files researchers open: NetCDF-4 with CF attributes, and CSV. Written beside the target and
// renamed, so that a failure leaves nothing that looks whole.
#pragma once

#include <filesystem>

#include "lighting/base/light_map.h"
#include "sim/forest/forest.h"

namespace sunfleck {

// NetCDF-4: dimensions element, band, tree; per element position, normal, area, tree id and, per band, front
// and back irradiance split into direct, sky and scattered, absorbed flux, standard error; sunlit fraction;
// per tree sums; budget; provenance as global attributes. Throws Error(kInputOutput).
void save_netcdf(const LightMap& map, const Forest& forest, const std::filesystem::path& path);
LightMap load_netcdf(const std::filesystem::path& path);

// CSV, one line per element (or per tree) and band, header with units in the names; no times in it, so equal
// runs give equal bytes.
void save_element_csv(const LightMap& map, const Forest& forest, const std::filesystem::path& path);
void save_tree_csv(const LightMap& map, const Forest& forest, const std::filesystem::path& path);

}  // namespace sunfleck
