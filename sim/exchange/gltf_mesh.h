// The binary side of a glTF file: triangles of prototypes with shared corners.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/plant/prototype_faces.h"

namespace sunfleck {

// Triangles of one material, corners once where neighbours share them.
struct GltfPrimitive {
  PlantPart part = PlantPart::kLeaf;
  std::uint32_t material = 0;  // of its prototype
  std::vector<Vec3f> positions_m;
  std::vector<std::uint32_t> corners;  // three for each triangle
};

// One for each part and material of the prototype, in order of first use. Triangles without area are left
// out.
std::vector<GltfPrimitive> gltf_primitives(const Prototype& prototype);

}  // namespace sunfleck
