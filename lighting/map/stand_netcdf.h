// A stand study as NetCDF-4 with CF attributes, for xarray, R and ncdump.
//
// Dimensions: time (the months, days or hours asked for, with time_bnds), x and y (ground cells), tree,
// sensor, layer, level (feet of the layers and the top), ring (zenith rings), angle. A variable
// tree_intercepted(time, tree) has its sum or share over the whole period in tree_intercepted_period(tree),
// its standard error in tree_intercepted_standard_error, named by ancillary_variables. Static ones stand
// alone. Global attributes say place, PAR factors and everything about the making (as in light maps:
// settings, skipped, notes, times are JSON). Values are floats, those of the plot and coordinates doubles.
#pragma once

#include <filesystem>

#include "lighting/map/stand_tables.h"

namespace sunfleck {

// Appears whole or not at all. Throws Error(kInputOutput).
void save_stand_netcdf(const StandTables& tables, const std::filesystem::path& path);

// What was saved: values as floats; measured shares stand in the sensor table only; pressure and
// temperature of the place are not in the file. Throws Error(kInvalidInput) where it is not a stand study.
StandTables load_stand_netcdf(const std::filesystem::path& path);

// Whether the file says so of itself. Throws as a file that cannot be opened does.
bool is_stand_netcdf(const std::filesystem::path& path);

}  // namespace sunfleck
