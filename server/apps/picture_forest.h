// The forest of a picture: only the trees that the picture needs, where the file allows it.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "lighting/base/light_map.h"
#include "lighting/render/render_config.h"
#include "sim/grid/read_selection.h"

namespace sunfleck {

struct PictureForest {
  Forest forest;  // all instances; prototypes that are not needed are empty
  RenderRequest request;
  std::string content_hash;  // of the whole forest
  std::string note;          // what was loaded, why, and how much light that may cost
  // Where prototypes were left out: of the whole, and which were loaded.
  std::optional<ForestOutline> whole;
  std::vector<char> loaded;

  // A light map of the whole forest as one of `forest`.
  LightMap light(LightMap of_whole) const;
};

// `request_for` makes the request for a forest of the given bounds. far_light: trees_for_picture.
PictureForest load_for_picture(const std::filesystem::path& path, RenderMode mode, double far_light,
                               const std::function<RenderRequest(const Box&)>& request_for);

}  // namespace sunfleck
