#include "sim/plant/template_element.h"

#include <cmath>

namespace sunfleck {
namespace {

// Half edges of an element of the given area; the first axis of the frame is the leaf's length.
struct HalfEdges {
  Vec3 u_m, v_m;
};

// Parallelogram (here: rectangle) of the species' length to width, 4 |u| |v| = area.
HalfEdges leaf_edges(const FoliageTemplate& foliage, double area_m2, const Vec3& length_axis,
                     const Vec3& width_axis) {
  const double ratio = foliage.leaf_length_m / foliage.leaf_width_m;
  const double half_width_m = 0.5 * std::sqrt(area_m2 / ratio);
  return {half_width_m * ratio * length_axis, half_width_m * width_axis};
}

// The template shoot scaled in all directions: needle area per volume stays.
HalfEdges shoot_edges(const FoliageTemplate& foliage, double area_m2, const Vec3& axis, const Vec3& across) {
  const double scale = std::cbrt(area_m2 / foliage.shoot_area_m2());
  return {0.5 * scale * foliage.shoot_length_m * axis, scale * foliage.shoot_radius_m * across};
}

}  // namespace

FoliageElement template_element(const FoliageTemplate& foliage, double area_m2, const Vec3& centre_m,
                                const Vec3& normal, double turn_rad) {
  const Basis basis = basis_around(normal);
  const Vec3 first = std::cos(turn_rad) * basis.tangent + std::sin(turn_rad) * basis.bitangent;
  const Vec3 second = glm::cross(normal, first);
  const bool is_leaf = foliage.kind == FoliageKind::kLeaf;
  const HalfEdges edges =
      is_leaf ? leaf_edges(foliage, area_m2, first, second) : shoot_edges(foliage, area_m2, first, second);
  FoliageElement element;
  element.centre_m = Vec3f(centre_m);
  element.half_u_m = Vec3f(edges.u_m);
  element.half_v_m = Vec3f(edges.v_m);
  element.area_m2 = static_cast<float>(area_m2);
  element.shape = is_leaf ? ElementShape::kParallelogram : ElementShape::kShoot;
  return element;
}

}  // namespace sunfleck
