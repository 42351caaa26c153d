// A picture of the stand for its report: leaves lit by the simplest method, a few seconds at most.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "lighting/map/stand_tables.h"

namespace sunfleck {

// PNG at `path`: the inventory's trees, seen from the south-east under a half-cloudy noon of the period's
// place. nullopt: drawn; else why not (too many leaves, or bands the picture needs are not known).
std::optional<std::string> draw_stand(const Forest& forest, const StandTables& tables,
                                      const std::filesystem::path& path, const RunControl& control);

}  // namespace sunfleck
