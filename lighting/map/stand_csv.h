// A stand study as CSV tables for R and spreadsheets: trees.csv, sensors.csv, ground.csv, layers.csv and
// plot.csv, one row per interval and target, units in the column names; leaf_projection.csv has the
// G-function by zenith angle. The first interval is the whole period. Empty: not known. No times of computing
// are in them: equal studies give equal bytes.
#pragma once

#include <filesystem>
#include <vector>

#include "lighting/map/stand_tables.h"

namespace sunfleck {

// Makes the folder if its parent is there; tables without rows are not written. Returns what was written.
// Throws Error(kInputOutput).
std::vector<std::filesystem::path> save_stand_csv(const StandTables& tables,
                                                  const std::filesystem::path& folder);

}  // namespace sunfleck
