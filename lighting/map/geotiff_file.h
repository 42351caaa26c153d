// A raster of 32-bit floats on a plane as a GeoTIFF: little-endian baseline TIFF 6.0 with one strip per band,
// tags of GeoTIFF 1.1 (OGC 19-008) for where it lies, and GDAL's own tags for what the bands are.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/base/vec.h"

namespace sunfleck {

struct GeoTiffBand {
  std::string name, description, units;
  std::vector<float> value;  // row by row from the north-west corner; NaN: not known
};

struct GeoRaster {
  std::uint32_t columns = 0, rows = 0;
  Vec2 north_west_m{0}, cell_m{1};  // outer corner; x east, y north
  int epsg = 0;                     // of the plane coordinates; 0: local metres, tied to no place
  std::vector<GeoTiffBand> bands;   // 1 .. 65,535
};

// Appears whole or not at all. Equal rasters give equal bytes. Throws Error(kInvalidInput): extension other
// than .tif or .tiff, no cells or bands, a band of another size; kLimitExceeded: over the 4 GiB of such
// files; kInputOutput.
void save_geotiff(const GeoRaster& raster, const std::filesystem::path& path);

}  // namespace sunfleck
