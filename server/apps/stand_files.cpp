#include "server/apps/stand_files.h"

#include <algorithm>

#include "lighting/map/ground_geotiff.h"
#include "lighting/map/stand_csv.h"
#include "lighting/map/stand_netcdf.h"
#include "lighting/report/stand_photographs.h"
#include "lighting/report/stand_pictures.h"
#include "lighting/report/stand_report.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

// The inventoried plot, where trees stand around it that nobody measured.
std::optional<PlotPolygon> plot_of(const SceneFile& scene) {
  if (!scene.forest || scene.forest->plot) return scene.forest ? scene.forest->plot : std::nullopt;
  const bool surrounded =
      scene.forest->surroundings != Surroundings::kNone && !scene.forest->inventory.empty();
  return surrounded ? std::optional(plot_around(scene.forest->inventory)) : std::nullopt;
}

}  // namespace

std::vector<Output> StandFiles::outputs() const {
  return {{"--netcdf", netcdf, ".nc"},        {"--csv", csv, ""},
          {"--report", report, ".html"},      {"--pictures", pictures, ""},
          {"--photographs", photographs, ""}, {"--geotiff", geotiff, ".tif"}};
}

bool StandFiles::any() const {
  const std::vector<Output> all = outputs();
  return std::any_of(all.begin(), all.end(), [](const Output& o) { return !o.path.empty(); });
}

StandStudySpec stand_spec_of(const std::filesystem::path& path, const SceneFile& scene) {
  if (!scene.stand_light)
    throw_invalid(path.string(), "has no [stand_light] table",
                  "say which place, period and radiation, see configs/examples/stand.toml");
  StandStudySpec spec = *scene.stand_light;
  const auto plot = plot_of(scene);
  if (!plot) return spec;
  spec.plot_area_m2 = area_m2(*plot);
  if (spec.map_lo_m) return spec;
  spec.map_lo_m = bounds(*plot).lo_m;
  spec.map_hi_m = bounds(*plot).hi_m;
  return spec;
}

std::vector<std::filesystem::path> write_stand_files(const StandFiles& files, const Forest& forest,
                                                     const StandStudy& study, const StandTables& tables,
                                                     const RunControl& control) {
  std::vector<std::filesystem::path> written;
  const auto add = [&](const std::vector<std::filesystem::path>& more) {
    written.insert(written.end(), more.begin(), more.end());
  };
  if (!files.netcdf.empty()) save_stand_netcdf(tables, files.netcdf), add({files.netcdf});
  if (!files.csv.empty()) add(save_stand_csv(tables, files.csv));
  if (!files.pictures.empty()) add(save_stand_pictures(study, tables, files.pictures));
  if (!files.geotiff.empty()) save_ground_geotiff(tables, files.epsg, files.geotiff), add({files.geotiff});
  if (!files.photographs.empty())
    add(save_photographs(forest, study.spec, files.photograph_px, files.photographs, control));
  if (!files.report.empty())
    save_stand_report(study, tables, forest, files.report, control), add({files.report});
  return written;
}

}  // namespace sunfleck
