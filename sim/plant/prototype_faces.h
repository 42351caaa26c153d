// A prototype as faces with parts and materials: what every mesh export writes.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "sim/plant/prototype.h"

namespace sunfleck {

enum class PlantPart { kLeaf, kShoot, kWood };

struct PlantFace {
  PlantPart part;
  std::uint32_t material;           // index into Prototype::materials
  std::span<const Vec3> corners_m;  // 3 to 8, counter-clockwise seen from the front or from outside
};

// Foliage first, then wood: leaves as faces (a disc as an octagon of its area), shoots and wood segments as
// eight-sided prisms, mesh wood as it is.
void for_each_face(const Prototype& prototype, const std::function<void(const PlantFace&)>& use);

// "leaf_Fagus_sylvatica": part and material, with _ for blanks and #.
std::string face_material_name(const Prototype& prototype, PlantPart part, std::uint32_t material);

}  // namespace sunfleck
