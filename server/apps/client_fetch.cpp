#include "server/apps/client_fetch.h"

#include <cstdio>

#include "lighting/map/light_map_file.h"
#include "lighting/plan/growth_light.h"
#include "lighting/render/camera_config.h"
#include "server/apps/outputs.h"
#include "server/apps/stand_summary.h"
#include "server/apps/summary.h"
#include "server/apps/terminal.h"
#include "server/client/stand_json.h"
#include "sim/base/error.h"
#include "sim/base/pending_file.h"

namespace sunfleck {
namespace {

// The forest a served scene was made of, grown here: tables need the places of its leaves. `notes`: what
// growing has to say.
Forest same_forest(const ClientOptions& o, const SceneFile& scene, const RunControl& control,
                   std::vector<std::string>* notes = nullptr) {
  if (!scene.forest)
    throw_invalid(o.scene.string(), "has no [forest] table", "the file the scene was made from");
  Forest forest = grow_lit_forest(*scene.forest, SpeciesLibrary::load(find_configs(o.configs) / "species"),
                                  control, notes);
  if ("scenes/" + content_hash(forest) != o.scene_name)
    throw_invalid("--scene", o.scene_name + " was not made from " + o.scene.string(),
                  "the file it was made from grows scenes/" + content_hash(forest));
  return forest;
}

// Without the forest's own file there are no tables of it: what the answer itself says.
void print_answer(const StandStudy& study) {
  std::printf("method       %s\n", study.provenance.method.c_str());
  std::printf("intervals    %zu, %s\n", study.intervals.size(), study.intervals.front().c_str());
  std::printf("open light   %.5g MJ m-2 direct, %.5g MJ m-2 diffuse\n", study.direct_horizontal_mj_m2.front(),
              study.diffuse_horizontal_mj_m2.front());
  if (study.fit)
    std::printf("sensors      %zu measured: rmse %.4f, bias %+.4f, correlation %.3f\n", study.fit->sensors,
                study.fit->rmse, study.fit->bias, study.fit->correlation);
  for (const std::string& note : study.provenance.notes) std::printf("note         %s\n", note.c_str());
}

void print_written(const std::vector<std::filesystem::path>& paths) {
  for (const auto& path : paths)
    if (!path.empty()) std::printf("wrote        %s\n", path.c_str());
}

StandFiles stand_files(const ClientOptions& o) {
  StandFiles files = o.stand;
  files.netcdf = o.output;
  files.csv = o.csv;
  return files;
}

}  // namespace

SceneFile required_scene_file(const ClientOptions& o) {
  if (o.scene.empty()) throw_invalid("--scene-file", "is missing", "the scene file to send");
  return read_scene_file(o.scene);
}

const std::string& required_scene_name(const ClientOptions& o) {
  if (o.scene_name.empty())
    throw_invalid("--scene", "is missing", "a name from client create or client list");
  return o.scene_name;
}

void fetch_light(const ClientOptions& o, Client& client, const RunControl& control) {
  check_outputs("client light",
                {{"-o", o.output, ".nc"}, {"--csv", o.csv, ".csv"}, {"--tree-csv", o.tree_csv, ".csv"}});
  const SceneFile scene = required_scene_file(o);
  const LightRequest request = light_request_of(o.scene, scene, o.method, o.trees);
  required_scene_name(o);
  const Forest whole = same_forest(o, scene, control);
  const LightMap map = client.light_map(o.scene_name, request, control);
  // What the answer's elements are numbered by: the trees asked for.
  const Forest forest = request.selection.everything() ? whole : selected_forest(whole, request.selection);
  if (!o.output.empty()) save_netcdf(map, forest, o.output);
  if (!o.csv.empty()) save_element_csv(map, forest, o.csv);
  if (!o.tree_csv.empty()) save_tree_csv(map, forest, o.tree_csv);
  finish_progress();
  print_light(map, forest);
  print_written({o.output, o.csv, o.tree_csv});
}

void fetch_stand(const ClientOptions& o, Client& client, const RunControl& control) {
  const StandFiles files = stand_files(o);
  std::vector<Output> outputs = files.outputs();
  outputs.push_back({"--json", o.json, ".json"});
  check_outputs("client stand", outputs);
  const SceneFile scene = required_scene_file(o);
  const StandStudySpec spec = stand_spec_of(o.scene, scene);
  required_scene_name(o);
  std::vector<std::string> notes;
  std::optional<Forest> forest;
  if (scene.forest || files.any()) forest = same_forest(o, scene, control, &notes);
  StandStudy study = client.stand_light(o.scene_name, spec, control);
  study.provenance.notes.insert(study.provenance.notes.begin(), notes.begin(), notes.end());
  if (!o.json.empty()) write_whole_file(o.json, stand_json(study, forest ? &*forest : nullptr));
  std::vector<std::filesystem::path> written{o.json};
  if (forest) {
    const StandTables tables = stand_tables(study, *forest);
    const auto more = write_stand_files(files, *forest, study, tables, control);
    written.insert(written.end(), more.begin(), more.end());
    finish_progress();
    print_stand(tables, forest->name);
  } else {
    finish_progress();
    print_answer(study);
  }
  print_written(written);
}

void fetch_picture(const ClientOptions& o, Client& client, const RunControl& control) {
  check_outputs("client render", {{"--png", o.png, ".png"}, {"--exr", o.exr, ".exr"}});
  const SceneFile scene = required_scene_file(o);
  const SceneInfo info = client.get_scene(required_scene_name(o));
  const Camera camera =
      scene.camera ? *scene.camera : default_camera(Box{info.bounds_lo_m, info.bounds_hi_m});
  const auto files = o.exr.empty()   ? Client::Files::kPng
                     : o.png.empty() ? Client::Files::kExr
                                     : Client::Files::kExrAndPng;
  LightRequest light = light_request_of(o.scene, scene, o.method, {});
  light.selection = {};  // a picture shows all trees
  RenderSettings settings = scene.render.value_or(RenderSettings{});
  if (!o.mode.empty()) settings.mode = render_mode_named(o.mode, "--mode");
  settings.effort.keep_when_stopped = settings.mode == RenderMode::kPathTraced || o.stop_after_s > 0;
  const RemoteRender picture =
      client.render(required_scene_name(o), light, camera, settings, files, control, {}, o.stop_after_s);
  if (!o.png.empty()) write_whole_file(o.png, picture.png);
  if (!o.exr.empty()) write_whole_file(o.exr, picture.exr);
  finish_progress();
  std::printf("image        %d x %d pixels in %zu tiles, %d samples each, rendered in %s%s\n",
              picture.width_px, picture.height_px, picture.tiles, picture.samples_per_pixel,
              seconds_text(picture.render_wall_s).c_str(), picture.stopped ? ", stopped early" : "");
  std::printf("noise        %.2f %% of the picture's mean brightness (RMS of its pixels)\n",
              100 * picture.noise);
  print_written({o.png, o.exr});
  if (picture.stopped && control.stop.stop_requested()) throw_cancelled();
}

}  // namespace sunfleck
