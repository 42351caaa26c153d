// What `sunfleck stand` and `sunfleck client stand` write: a study, wherever it was computed, as files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lighting/map/stand_tables.h"
#include "server/apps/outputs.h"
#include "server/apps/scene_file.h"

namespace sunfleck {

struct StandFiles {
  std::filesystem::path netcdf, csv, report, pictures, photographs, geotiff;  // empty: not asked for
  int photograph_px = 600;
  int epsg = 0;  // of the inventory's plane coordinates, for the GeoTIFF; 0: not known

  std::vector<Output> outputs() const;
  bool any() const;
};

// The [stand_light] table of the scene. Without a [stand_light.map] the question is about the plot, not about
// the trees put around it. Throws Error(kInvalidInput) where there is no such table.
StandStudySpec stand_spec_of(const std::filesystem::path& path, const SceneFile& scene);

// `forest` and `study` belong together. Returns what was written.
std::vector<std::filesystem::path> write_stand_files(const StandFiles& files, const Forest& forest,
                                                     const StandStudy& study, const StandTables& tables,
                                                     const RunControl& control);

}  // namespace sunfleck
