// One page about a stand's light that a person reads in a browser, without a server and without the network:
// what was asked, the stand, ground map, height profile, season, sensors against measurements, tables,
// methods, errors and notes. Pictures and style are inside the file.
#pragma once

#include <filesystem>

#include "lighting/map/stand_tables.h"

namespace sunfleck {

// HTML 5 at `path`, whole or not at all. Text that users wrote is escaped. Throws Error(kInputOutput), also
// where gnuplot is missing.
void save_stand_report(const StandStudy& study, const StandTables& tables, const Forest& forest,
                       const std::filesystem::path& path, const RunControl& control);

}  // namespace sunfleck
