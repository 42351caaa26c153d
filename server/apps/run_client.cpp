#include <cstdio>

#include "server/apps/client_fetch.h"
#include "server/apps/terminal.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

constexpr double kPatience_s = 5;

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
