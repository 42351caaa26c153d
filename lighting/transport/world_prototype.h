// What the world grid needs to know of a prototype: where its leaf and wood area is, how much of it counts,
// and a sample of its leaf angles.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/base/run_control.h"
#include "sim/forest/forest.h"

namespace sunfleck::transport {

// A cell of the prototype's own grid, in its own frame and size.
struct CrownCell {
  Vec3f centre_m{0};
  float leaf_m2 = 0, wood_m2 = 0;  // effective: area times `counts`
};

// An element whose angle and optics stand for its share of the leaf area.
struct AngleSample {
  Vec3 axis{0, 0, 1};  // front normal, or half the axis of a shoot
  double shoot_radius_m = 0, shoot_area_m2 = 0;
  double share = 0;
  std::uint16_t material = 0;
  bool is_shoot = false;
};

// Wood: `vector` and `width_m` as in FieldWood.
struct WoodSample {
  Vec3 vector{0};
  double width_m = 0, area_m2 = 0;
  std::uint32_t material = 0;
};

struct WorldPrototype {
  std::vector<CrownCell> cells;
  std::vector<AngleSample> angles;  // at most kMostAngles
  std::vector<WoodSample> wood;     // the pieces with the most area
  double leaf_area_m2 = 0, wood_area_m2 = 0;
  double leaf_side_m = 0, crown_width_m = 0;
  Box bounds;
};

inline constexpr std::size_t kMostAngles = 512;

double prototype_leaf_side(const Prototype& prototype);

// Cells with edge `cell_m`; a block of two by two by two of them is as large as a cell of the world. Leaf
// area counts in the measure of
//   -ln(mean over columns of exp(-depth of the column)) / mean depth,
// columns of the block one fine cell (about 2.5 leaf sides) wide, averaged over the three axes; depths as in
// cell_contents.h. In a random medium that is near 1, in clumps as large as a fine cell and more below it.
WorldPrototype world_prototype(const Prototype& prototype, double cell_m, const RunControl& control);

}  // namespace sunfleck::transport
