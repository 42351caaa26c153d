// stand: from a scene file to a season's light as tables, pictures and a page.
#include <cstdio>

#include "lighting/plan/growth_light.h"
#include "server/apps/commands.h"
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
  return grow_lit_forest(*scene.forest, SpeciesLibrary::load(find_configs(o.configs) / "species"), control,
                         &notes);
}

}  // namespace

void run_stand(const StandOptions& o, const RunControl& control) {
  check_outputs("stand", o.files.outputs());
  const SceneFile scene = read_scene_file(o.scene);
  const StandStudySpec spec = stand_spec_of(o.scene, scene);
  std::vector<std::string> notes;
  const Forest forest = forest_of(o, scene, control, notes);
  StandStudy study = run_stand_study(forest, spec, control);
  study.provenance.notes.insert(study.provenance.notes.begin(), notes.begin(), notes.end());
  const StandTables tables = stand_tables(study, forest);
  const auto written = write_stand_files(o.files, forest, study, tables, control);
  finish_progress();
  print_stand(tables, forest.name);
  for (const auto& path : written) std::printf("wrote        %s\n", path.c_str());
}

}  // namespace sunfleck
