// The ground map of a stand study as a GeoTIFF for geographic information systems.
#pragma once

#include "lighting/map/geotiff_file.h"
#include "lighting/map/stand_tables.h"

namespace sunfleck {

// Bands: every variable of the ground table over the whole period, those with errors followed by them
// ("pacl_total", "pacl_total_standard_error"), then "pacl_total" of every month, day or hour by its label.
// `epsg`: number of the projected system that the inventory's plane coordinates are of (EPSG, say 32632 for
// UTM 32 north); 0: local metres. Errors as save_geotiff().
GeoRaster ground_raster(const StandTables& tables, int epsg);
void save_ground_geotiff(const StandTables& tables, int epsg, const std::filesystem::path& path);

}  // namespace sunfleck
