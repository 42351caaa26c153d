// A large stand as boxes of leaf and wood area, each box knowing which trees its area belongs to.
//
// Boxes are `voxel_m` wide and high, over the period or the forest's bounds, from the ground plane up (on a
// slope they follow the ground). Every prototype is thinned to small lumps of area first, which its instances
// put into boxes; leaves within a lump and box count as evenly spread, what that gets wrong is measured per
// prototype (crown_optics.h).
#pragma once

#include <cstdint>
#include <vector>

#include "sim/base/run_control.h"
#include "sim/forest/forest.h"

namespace sunfleck {

// Area of a prototype around a point: leaves one-sided; wood as the leaf area that shades as much when turned
// any way.
struct AreaLump {
  Vec3f centre_m{0};
  float area_m2 = 0;
};
// Lumps about `size_m` wide, in tree coordinates, in a fixed order.
std::vector<AreaLump> area_lumps(const Prototype& prototype, double size_m);

struct CanopyEntry {
  std::uint32_t voxel = 0;
  float area_m2 = 0;
};

struct BoxCanopy {
  Vec2 lo_m{0};
  double voxel_m = 1, height_m = 1;  // edge of a box; height of one (the same but for rounding)
  Vec2 edge_m{1};                    // edges of a box in x and y: the period is a whole number of boxes
  std::uint32_t nx = 1, ny = 1, nz = 1;
  bool periodic = false;
  Vec3 ground_normal{0, 0, 1};
  // Trees (instances) tile by tile of the plane, so that the boxes of one are near those of the next and stay
  // in the caches; the entries follow that order.
  std::vector<std::uint32_t> order;
  std::vector<std::size_t> first_entry;  // of each tree of `order`, and the end
  std::vector<CanopyEntry> entries;      // tree by tree, by rising voxel; index = (z * ny + y) * nx + x

  std::size_t voxel_count() const { return static_cast<std::size_t>(nx) * ny * nz; }
  double facing(const Vec3& to_source) const {
    const double cosine = glm::dot(to_source, ground_normal);
    return to_source.z > 0.0 && cosine > 0.0 ? cosine / ground_normal.z : 0.0;
  }
};

// `voxel_m` > 0. Throws Error(kInvalidInput) for a forest without trees, Error(kLimitExceeded) for more than
// 400 million boxes.
BoxCanopy box_canopy(const Forest& forest, double voxel_m, const RunControl& control);

}  // namespace sunfleck
