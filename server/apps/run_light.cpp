#include <cstdio>

#include "lighting/map/light_map_file.h"
#include "server/apps/commands.h"
#include "server/apps/outputs.h"
#include "server/apps/scene_file.h"
#include "server/apps/summary.h"
#include "server/apps/terminal.h"
#include "sim/base/error.h"
#include "sim/grid/forest_file.h"

namespace sunfleck {

void run_light(const LightOptions& o, const RunControl& control) {
  check_outputs(
      "light",
      {{"-o", o.netcdf, ".nc"}, {"--csv", o.element_csv, ".csv"}, {"--tree-csv", o.tree_csv, ".csv"}});
  const SceneFile scene = read_scene_file(o.scene);
  const LightRequest request = light_request_of(o.scene, scene, o.method, o.trees);
  const Forest whole = load_forest(o.forest);
  const LightMap map = compute_light_map(whole, request, {.threads = o.threads}, control);
  // What the answer's elements are numbered by: the trees asked for.
  const Forest forest = request.selection.everything() ? whole : selected_forest(whole, request.selection);
  if (!o.netcdf.empty()) save_netcdf(map, forest, o.netcdf);
  if (!o.element_csv.empty()) save_element_csv(map, forest, o.element_csv);
  if (!o.tree_csv.empty()) save_tree_csv(map, forest, o.tree_csv);
  finish_progress();
  print_light(map, forest);
  for (const auto& path : {o.netcdf, o.element_csv, o.tree_csv})
    if (!path.empty()) std::printf("wrote        %s\n", path.c_str());
}

}  // namespace sunfleck
