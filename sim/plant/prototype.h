// One tree in its own frame: stem foot at the origin, z up, metres. What light is computed for (foliage
// elements) and what only shades (wood).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/base/vec.h"

namespace sunfleck {

enum class ElementShape : std::uint8_t {
  kParallelogram,  // centre +- half_u +- half_v
  kDisc,           // centre, radius |half_u| = |half_v|, half_u perpendicular to half_v
  kTriangle,  // corners centre - (u+v)/3, + u, + v with u = half_u, v = half_v (full edges from one corner)
  kShoot      // cylinder: axis centre +- half_u, radius |half_v|, filled evenly with randomly turned needles
};

// A foliage element: a flat two-sided leaf, or a shoot of needles. For a flat element the front normal is
// half_u x half_v normalised and area_m2 its area; for a shoot area_m2 is the one-sided (half of the total)
// needle area, and front and back mean the two faces of needles whose normals point everywhere alike.
struct FoliageElement {
  Vec3f centre_m{0};
  Vec3f half_u_m{0};
  Vec3f half_v_m{0};
  float area_m2 = 0;
  ElementShape shape = ElementShape::kParallelogram;
  std::uint8_t unused = 0;     // keeps the struct free of padding
  std::uint16_t material = 0;  // index into Prototype::materials
};
static_assert(sizeof(FoliageElement) == 44);

// Opaque tapered cylinder without end caps.
struct WoodSegment {
  Vec3f from_m{0};
  Vec3f to_m{0};
  float radius_from_m = 0;
  float radius_to_m = 0;
  std::uint32_t material = 0;
};

// Opaque triangle of an imported mesh (both sides block and reflect).
struct WoodTriangle {
  Vec3f a_m{0}, b_m{0}, c_m{0};
  std::uint32_t material = 0;
};

// What a forester measures on the tree.
struct TreeMeasures {
  double dbh_m = 0;         // stem diameter at 1.3 m
  double height_m = 0;      // top of the highest element or segment
  double crown_base_m = 0;  // height of the lowest foliage
  double crown_radius_m =
      0;                    // mean over eight 45 degree sectors of the largest horizontal distance of foliage
  double leaf_area_m2 = 0;  // one-sided
};

struct Prototype {
  std::string name;
  std::vector<std::string> materials;  // names resolved against Forest::materials, usually one species
  std::vector<FoliageElement> foliage;
  std::vector<WoodSegment> wood;
  std::vector<WoodTriangle> wood_mesh;
  double stated_dbh_m =
      0;  // from the inventory or allometry; measure() reports it where there is no stem at 1.3 m
};

// Front normal of a flat element (unit). Not for shoots.
Vec3 element_normal(const FoliageElement& element);
// Area of a flat element from its edges; for a shoot, area_m2.
double element_geometric_area(const FoliageElement& element);
// Box that holds the element with all its extent.
Box element_bounds(const FoliageElement& element);
Box prototype_bounds(const Prototype& prototype);
// Radius of a cylinder round the z axis that holds everything, a millionth wider for the rounding of floats.
double prototype_reach_m(const Prototype& prototype);
double leaf_area_m2(const Prototype& prototype);
TreeMeasures measure(const Prototype& prototype);

// Throws Error(kInvalidInput) that names `where` and the first bad element: not finite, area < 0 or not that
// of its edges (1e-3 relative), material out of range, negative radius.
void validate(const Prototype& prototype, const std::string& where);

}  // namespace sunfleck
