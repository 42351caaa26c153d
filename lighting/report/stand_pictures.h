// Pictures of a stand study: the ground map, height profiles, the course of the season, modelled against
// measured light.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "lighting/map/ground_picture.h"
#include "lighting/map/plot.h"
#include "lighting/map/stand_tables.h"

namespace sunfleck {

// Each is there where the study holds its numbers.
std::optional<GroundPicture> ground_picture(const StandTables& tables);
std::optional<PlotPage> profile_plot(const StandTables& tables);
std::optional<PlotPage> season_plot(const StandTables& tables);
std::optional<PlotPage> scatter_plot(const StandStudy& study, const StandTables& tables);
std::optional<PlotPage> leaf_projection_plot(const StandTables& tables);

// ground_map.png, height_profile.png, season.png, sensors.png, leaf_projection.png in a folder that is made
// where missing. Returns what was written. Throws Error(kInputOutput).
std::vector<std::filesystem::path> save_stand_pictures(const StandStudy& study, const StandTables& tables,
                                                       const std::filesystem::path& folder);

}  // namespace sunfleck
