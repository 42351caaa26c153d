// stand: from a scene file to a season's light as tables, pictures and a page.
#include <cstdio>

#include "lighting/map/stand_csv.h"
#include "lighting/map/stand_netcdf.h"
#include "lighting/report/stand_photographs.h"
#include "lighting/report/stand_pictures.h"
#include "lighting/report/stand_report.h"
#include "server/apps/commands.h"
#include "server/apps/outputs.h"
#include "server/apps/scene_file.h"
#include "server/apps/stand_summary.h"
#include "server/apps/terminal.h"
#include "sim/base/error.h"
#include "sim/grid/forest_file.h"

namespace sunfleck {
namespace {

Forest forest_of(const StandOptions& o, const SceneFile& scene, const RunControl& control,
                 std::vector<std::string>& notes) {
  if (!o.forest.empty()) return load_forest(o.forest);
  if (!scene.forest)
    throw_invalid(o.scene.string(), "has no [forest] table", "say what to grow, or give --forest FILE.vdb");
  return grow_forest(*scene.forest, SpeciesLibrary::load(find_configs(o.configs) / "species"), control,
                     &notes);
}

// The inventoried plot, where trees stand around it that nobody measured.
std::optional<PlotPolygon> plot_of(const SceneFile& scene) {
  if (!scene.forest || scene.forest->plot) return scene.forest ? scene.forest->plot : std::nullopt;
  const bool surrounded =
      scene.forest->surroundings != Surroundings::kNone && !scene.forest->inventory.empty();
  return surrounded ? std::optional(plot_around(scene.forest->inventory)) : std::nullopt;
}

// Without a [stand_light.map] the question is about the plot, not about the trees put around it.
StandStudySpec spec_of(const StandOptions& o, const SceneFile& scene) {
  if (!scene.stand_light)
    throw_invalid(o.scene.string(), "has no [stand_light] table",
                  "say which place, period and radiation, see configs/examples/stand.toml");
  StandStudySpec spec = *scene.stand_light;
  const auto plot = plot_of(scene);
  if (spec.map_lo_m || !plot) return spec;
  spec.map_lo_m = bounds(*plot).lo_m;
  spec.map_hi_m = bounds(*plot).hi_m;
  return spec;
}

void print_written(const std::vector<std::filesystem::path>& paths) {
  for (const auto& path : paths) std::printf("wrote        %s\n", path.c_str());
}

}  // namespace

void run_stand(const StandOptions& o, const RunControl& control) {
  check_outputs("stand", {{"--netcdf", o.netcdf, ".nc"},
                          {"--csv", o.csv, ""},
                          {"--report", o.report, ".html"},
                          {"--pictures", o.pictures, ""},
                          {"--photographs", o.photographs, ""}});
  const SceneFile scene = read_scene_file(o.scene);
  const StandStudySpec spec = spec_of(o, scene);
  std::vector<std::string> notes;
  const Forest forest = forest_of(o, scene, control, notes);
  StandStudy study = run_stand_study(forest, spec, control);
  study.provenance.notes.insert(study.provenance.notes.begin(), notes.begin(), notes.end());
  const auto plot = plot_of(scene);
  const double plot_m2 = plot ? area_m2(*plot) : 0;
  const StandTables tables = stand_tables(study, forest, {.plot_area_m2 = plot_m2});
  std::vector<std::filesystem::path> written;
  const auto add = [&](const std::vector<std::filesystem::path>& more) {
    written.insert(written.end(), more.begin(), more.end());
  };
  if (!o.netcdf.empty()) save_stand_netcdf(tables, o.netcdf), add({o.netcdf});
  if (!o.csv.empty()) add(save_stand_csv(tables, o.csv));
  if (!o.pictures.empty()) add(save_stand_pictures(study, tables, o.pictures));
  if (!o.photographs.empty()) add(save_photographs(forest, spec, o.photograph_px, o.photographs, control));
  if (!o.report.empty()) save_stand_report(study, tables, forest, o.report, control), add({o.report});
  finish_progress();
  print_stand(tables, forest.name);
  print_written(written);
}

}  // namespace sunfleck
