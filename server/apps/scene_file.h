// A scene file: [forest], [light], [stand_light], [camera] and [render] in one TOML.
#pragma once

#include <filesystem>
#include <optional>

#include "lighting/plan/light_request.h"
#include "lighting/render/render_config.h"
#include "lighting/study/stand_study.h"
#include "sim/forest/forest_spec.h"

namespace sunfleck {

struct SceneFile {
  std::optional<ForestSpec> forest;
  std::optional<LightRequest> light;
  std::optional<StandStudySpec> stand_light;
  std::optional<Camera> camera;
  std::optional<RenderSettings> render;
};

// Reads all tables that are there and refuses every key that nobody knows.
SceneFile read_scene_file(const std::filesystem::path& path);

// The [light] table of the scene, with that method and those trees where they are given. Throws
// Error(kInvalidInput) where there is none.
LightRequest light_request_of(const std::filesystem::path& path, const SceneFile& scene,
                              const std::string& method, const std::vector<std::uint32_t>& trees);

// The folder with species and grammars: `given` if not empty, else $SUNFLECK_CONFIGS, else "configs" under
// the current folder or under a folder above the program. Throws Error(kNotFound).
std::filesystem::path find_configs(const std::filesystem::path& given);

}  // namespace sunfleck
