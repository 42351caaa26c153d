#include "sim/plant/prototype_faces.h"

#include <algorithm>
#include <array>

#include "sim/plant/element_faces.h"

namespace sunfleck {
namespace {

using Use = std::function<void(const PlantFace&)>;

void prism(const Vec3& from_m, const Vec3& to_m, double radius_from_m, double radius_to_m, PlantPart part,
           std::uint32_t material, const Use& use) {
  for (const auto& side : prism_sides(from_m, to_m, radius_from_m, radius_to_m)) use({part, material, side});
}

void foliage_faces(const FoliageElement& e, const Use& use) {
  if (e.shape != ElementShape::kShoot) return use({PlantPart::kLeaf, e.material, leaf_corners(e)});
  const Vec3 centre_m(e.centre_m), half_axis_m(e.half_u_m);
  const double radius_m = glm::length(Vec3(e.half_v_m));
  prism(centre_m - half_axis_m, centre_m + half_axis_m, radius_m, radius_m, PlantPart::kShoot, e.material,
        use);
}

}  // namespace

void for_each_face(const Prototype& prototype, const Use& use) {
  for (const FoliageElement& element : prototype.foliage) foliage_faces(element, use);
  for (const WoodSegment& s : prototype.wood)
    prism(s.from_m, s.to_m, s.radius_from_m, s.radius_to_m, PlantPart::kWood, s.material, use);
  for (const WoodTriangle& t : prototype.wood_mesh)
    use({PlantPart::kWood, t.material, std::array<Vec3, 3>{t.a_m, t.b_m, t.c_m}});
}

std::string face_material_name(const Prototype& prototype, PlantPart part, std::uint32_t material) {
  const char* kind = part == PlantPart::kLeaf ? "leaf_" : part == PlantPart::kShoot ? "shoot_" : "wood_";
  std::string name = kind + prototype.materials.at(material);
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return c <= ' ' || c == '#'; }, '_');
  return name;
}

}  // namespace sunfleck
