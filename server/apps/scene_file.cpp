#include "server/apps/scene_file.h"

#include <cstdlib>

#include "lighting/plan/light_config.h"
#include "lighting/render/camera_config.h"
#include "sim/base/error.h"

namespace sunfleck {

namespace fs = std::filesystem;

SceneFile read_scene_file(const fs::path& path) {
  const ConfigTable root = ConfigTable::from_file(path);
  SceneFile scene;
  if (const auto table = root.table_if("forest")) scene.forest = read_forest_spec(*table);
  if (const auto table = root.table_if("light")) scene.light = read_light_request(*table);
  if (const auto table = root.table_if("stand_light")) scene.stand_light = read_stand_study(*table);
  if (const auto table = root.table_if("camera")) scene.camera = read_camera(*table);
  if (const auto table = root.table_if("render")) scene.render = read_render_settings(*table);
  root.reject_unread();
  return scene;
}

LightRequest light_request_of(const fs::path& path, const SceneFile& scene, const std::string& method,
                              const std::vector<std::uint32_t>& trees) {
  if (!scene.light) throw_invalid(path.string(), "has no [light] table", "say which sun, sky and bands");
  LightRequest request = *scene.light;
  if (!method.empty()) request.method = method_from_string(method, "--method");
  if (trees.empty()) return request;
  request.selection.trees.clear();
  for (const std::uint32_t id : trees) request.selection.trees.push_back(TreeId{id});
  return request;
}

fs::path find_configs(const fs::path& given) {
  const auto has_species = [](const fs::path& folder) { return fs::is_directory(folder / "species"); };
  if (!given.empty()) {
    if (has_species(given)) return given;
    throw Error(ErrorKind::kNotFound, given.string(), "holds no folder 'species'",
                "the project's configs folder");
  }
  if (const char* variable = std::getenv("SUNFLECK_CONFIGS")) return find_configs(variable);
  if (has_species("configs")) return "configs";
  std::error_code ignored;
  for (fs::path folder = fs::read_symlink("/proc/self/exe", ignored); folder.has_relative_path();
       folder = folder.parent_path())
    if (has_species(folder / "configs")) return folder / "configs";
  throw Error(ErrorKind::kNotFound, "configs", "species and grammars were not found",
              "--configs FOLDER, or set SUNFLECK_CONFIGS");
}

}  // namespace sunfleck
