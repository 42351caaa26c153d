#include "lighting/map/ground_geotiff.h"

#include "sim/base/error.h"

namespace sunfleck {
namespace {

// Rows of the map run from the south, those of a raster from the north.
std::vector<float> northern_first(const StandGround& map, const std::vector<double>& value,
                                  std::size_t interval) {
  std::vector<float> cells;
  cells.reserve(map.count());
  for (std::size_t row = map.ny; row-- > 0;)
    for (std::size_t column = 0; column < map.nx; ++column)
      cells.push_back(static_cast<float>(value[interval * map.count() + row * map.nx + column]));
  return cells;
}

}  // namespace

GeoRaster ground_raster(const StandTables& tables, int epsg) {
  const StandGround& map = tables.map;
  GeoRaster raster{map.nx, map.ny, map.lo_m + Vec2(0, map.size_m().y), map.cell_m, epsg, {}};
  const StandTable* ground = tables.find(StandTarget::kGround);
  if (!ground) return raster;
  for (const StandVariable& v : ground->variables) {
    raster.bands.push_back({v.name, v.long_name, v.units, northern_first(map, v.value, 0)});
    if (!v.standard_error.empty())
      raster.bands.push_back({v.name + "_standard_error", "standard error of " + v.long_name, v.units,
                              northern_first(map, v.standard_error, 0)});
  }
  if (const StandVariable* pacl = ground->find("pacl_total"))
    for (std::size_t i = 1; i < tables.intervals.size(); ++i)
      raster.bands.push_back({"pacl_total " + tables.intervals[i], pacl->long_name, pacl->units,
                              northern_first(map, pacl->value, i)});
  return raster;
}

void save_ground_geotiff(const StandTables& tables, int epsg, const std::filesystem::path& path) {
  save_geotiff(ground_raster(tables, epsg), path);
}

}  // namespace sunfleck
