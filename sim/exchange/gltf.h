// A forest as glTF 2.0 in one binary file (.glb), as Blender and other viewers open it.
//
// Each prototype is one mesh, each instance a node that refers to it, under a root node that turns our z-up
// metres into glTF's y-up. Leaves as triangles seen from both sides (a disc as an octagon of its area),
// shoots and wood segments as eight-sided prisms. Colours are those of the species' PAR reflectance, for the
// eye only; light, periods and terrain are not in the file.
#pragma once

#include <cstddef>
#include <filesystem>

#include "sim/base/run_control.h"
#include "sim/forest/forest.h"

namespace sunfleck {

struct GltfReport {
  std::size_t meshes = 0, nodes = 0, triangles = 0;  // triangles of all meshes once
  std::size_t bytes = 0;
};

// Prototypes that no instance uses are left out. Written beside and renamed. Throws Error(kInvalidInput) for
// a forest without instances, kLimitExceeded for more than a million instances or 4 GiB.
GltfReport export_gltf(const Forest& forest, const std::filesystem::path& path,
                       const RunControl& control = {});

}  // namespace sunfleck
