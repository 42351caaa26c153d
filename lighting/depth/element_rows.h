// The foliage of a prototype as one array per number, for loops in vector registers.
#pragma once

#include <array>
#include <vector>

#include "sim/plant/prototype.h"

namespace sunfleck {

struct ElementRows {
  std::vector<float> u_x, u_y, u_z, v_x, v_y, v_z;  // half edges; v 0 for shoots
  std::vector<float> radius_m;                      // of shoots, else 0
  std::vector<float> x_m, y_m, z_m;                 // centres, tree frame
  std::vector<float> normal_x, normal_y, normal_z;  // times area, m2; 0 for shoots
  std::vector<float> needles_m2;                    // shown to any direction by a shoot, 0 for leaves
  std::vector<float> longest_m;                     // edge that maps may have to cut

  double typical_side_m = 0;  // typical_leaf_side_m()

  std::size_t size() const { return x_m.size(); }
};
ElementRows element_rows(const Prototype& prototype);

// p -> m p + the last column.
struct AffineFloat {
  std::array<std::array<float, 4>, 3> row{};
};

}  // namespace sunfleck
