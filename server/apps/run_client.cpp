#include <cmath>
#include <cstdio>

#include "lighting/map/light_map_file.h"
#include "lighting/render/camera_config.h"
#include "server/apps/commands.h"
#include "server/apps/outputs.h"
#include "server/apps/scene_file.h"
#include "server/apps/summary.h"
#include "server/apps/terminal.h"
#include "server/client/client.h"
#include "server/client/stand_json.h"
#include "sim/base/error.h"
#include "sim/base/pending_file.h"

namespace sunfleck {
namespace {

constexpr double kPatience_s = 5;

SceneFile required_scene_file(const ClientOptions& o) {
  if (o.scene.empty()) throw_invalid("--scene-file", "is missing", "the scene file to send");
  return read_scene_file(o.scene);
}

const std::string& required_scene_name(const ClientOptions& o) {
  if (o.scene_name.empty())
    throw_invalid("--scene", "is missing", "a name from client create or client list");
  return o.scene_name;
}

LightRequest required_light(const ClientOptions& o, const SceneFile& scene) {
  if (!scene.light) throw_invalid(o.scene.string(), "has no [light] table", "say which sun, sky and bands");
  LightRequest request = *scene.light;
  if (!request.selection.everything())
    throw_invalid(o.scene.string(), "asks for some trees only, which the service cannot do",
                  "leave light.trees out, or use `sunfleck light`");
  if (!o.method.empty()) request.method = method_from_string(o.method, "--method");
  return request;
}

// The forest a served scene was made of, grown here: tables need the places of its leaves.
Forest same_forest(const ClientOptions& o, const SceneFile& scene, const RunControl& control) {
  if (!scene.forest)
    throw_invalid(o.scene.string(), "has no [forest] table", "the file the scene was made from");
  Forest forest =
      grow_forest(*scene.forest, SpeciesLibrary::load(find_configs(o.configs) / "species"), control);
  if ("scenes/" + content_hash(forest) != o.scene_name)
    throw_invalid("--scene", o.scene_name + " was not made from " + o.scene.string(),
                  "the file it was made from grows scenes/" + content_hash(forest));
  return forest;
}

void print_scene(const SceneInfo& s) {
  std::printf("%s  %s: %s trees, %s foliage elements, %.6g m2 of leaf\n", s.name.c_str(),
              s.forest_name.c_str(), grouped(s.trees).c_str(), grouped(s.elements).c_str(), s.leaf_area_m2);
}

void print_info(Client& client) {
  const ServerReport report = client.info();
  std::printf("server       sunfleck %s (%s)\nmethods     ", report.version.c_str(), report.build.c_str());
  for (const std::string& m : report.methods) std::printf(" %s", m.c_str());
  std::printf("\n");
  for (const auto& [name, value] : report.limits)
    std::printf("limit        %s = %s\n", name.c_str(), value.c_str());
  for (const auto& [name, value] : report.load)
    std::printf("load         %s = %s\n", name.c_str(), value.c_str());
}

void fetch_light(const ClientOptions& o, Client& client, const RunControl& control) {
  check_outputs(
      "client light",
      {{"-o", o.netcdf, ".nc"}, {"--csv", o.element_csv, ".csv"}, {"--tree-csv", o.tree_csv, ".csv"}});
  const SceneFile scene = required_scene_file(o);
  const LightRequest request = required_light(o, scene);
  required_scene_name(o);
  const Forest forest = same_forest(o, scene, control);
  const LightMap map = client.light_map(o.scene_name, request, control);
  if (!o.netcdf.empty()) save_netcdf(map, forest, o.netcdf);
  if (!o.element_csv.empty()) save_element_csv(map, forest, o.element_csv);
  if (!o.tree_csv.empty()) save_tree_csv(map, forest, o.tree_csv);
  finish_progress();
  print_light(map, forest);
  for (const auto& path : {o.netcdf, o.element_csv, o.tree_csv})
    if (!path.empty()) std::printf("wrote        %s\n", path.c_str());
}

void print_stand(const StandStudy& study) {
  std::printf("method       %s\n", study.provenance.method.c_str());
  std::printf("intervals    %zu, %s\n", study.intervals.size(), study.intervals.front().c_str());
  std::printf("open light   %.5g MJ m-2 direct, %.5g MJ m-2 diffuse\n", study.direct_horizontal_mj_m2.front(),
              study.diffuse_horizontal_mj_m2.front());
  if (study.period)
    std::printf("leaf area    %.4g m2 per m2 of ground\n", study.period->plot.leaf_area_index);
  if (study.fit)
    std::printf("sensors      %zu measured: rmse %.4f, bias %+.4f, correlation %.3f\n", study.fit->sensors,
                study.fit->rmse, study.fit->bias, study.fit->correlation);
  for (const std::string& note : study.provenance.notes) std::printf("note         %s\n", note.c_str());
}

void fetch_stand(const ClientOptions& o, Client& client, const RunControl& control) {
  check_outputs("client stand", {{"--json", o.json, ".json"}});
  const SceneFile scene = required_scene_file(o);
  if (!scene.stand_light)
    throw_invalid(o.scene.string(), "has no [stand_light] table", "say which place, period and radiation");
  const StandStudy study = client.stand_light(required_scene_name(o), *scene.stand_light, control);
  write_whole_file(o.json, stand_json(study));
  finish_progress();
  print_stand(study);
  std::printf("wrote        %s\n", o.json.c_str());
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
  const RemoteRender picture =
      client.render(required_scene_name(o), required_light(o, scene), camera, files, control);
  if (!o.png.empty()) write_whole_file(o.png, picture.png);
  if (!o.exr.empty()) write_whole_file(o.exr, picture.exr);
  finish_progress();
  std::printf("image        %d x %d pixels in %zu tiles, rendered in %s\n", picture.width_px,
              picture.height_px, picture.tiles, seconds_text(picture.render_wall_s).c_str());
  for (const auto& path : {o.png, o.exr})
    if (!path.empty()) std::printf("wrote        %s\n", path.c_str());
}

}  // namespace

void run_client(const ClientOptions& o, const RunControl& control) {
  ConnectOptions connect;
  connect.target = o.address;
  Client client(connect);
  client.wait_until_ready(kPatience_s);
  if (o.action == "info") return print_info(client);
  if (o.action == "create") {
    const SceneFile scene = required_scene_file(o);
    if (!scene.forest) throw_invalid(o.scene.string(), "has no [forest] table", "say what to grow");
    const SceneInfo info = client.create_scene(*scene.forest, control);
    finish_progress();
    return print_scene(info);
  }
  if (o.action == "list") {
    for (const SceneInfo& s : client.list_scenes()) print_scene(s);
    return;
  }
  if (o.action == "delete") {
    client.delete_scene(required_scene_name(o));
    std::printf("deleted      %s\n", o.scene_name.c_str());
    return;
  }
  if (o.action == "light") return fetch_light(o, client, control);
  if (o.action == "stand") return fetch_stand(o, client, control);
  fetch_picture(o, client, control);
}

}  // namespace sunfleck
