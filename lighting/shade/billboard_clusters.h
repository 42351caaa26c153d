// Planes that stand for groups of leaves: the clustering behind a billboard cloud ([Garcia07] 4.1, after
// Behrendt et al. 2005). The paper only cites its clustering; this cost is that of our design sheet:
//   (h^2 + (da^2 + db^2) / 2) / s^2 + w_angle (1 - |n.np|) + w_centre |c - centroid|^2 / R^2,
// h the leaf centre's distance from the plane, da and db the parts of its half edges across the plane, s the
// mean half edge, R the crown's radius. Orientation matters more than distance: a leaf seen foreshortened on
// its plane loses cover, one turned into it has the wrong outline; height over the plane is kept (relief).
// w_angle = 100 gave the least error of pictures at 130 to 260 planes (20 without relief).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/base/run_control.h"
#include "sim/plant/prototype.h"

namespace sunfleck {

struct ClusterOptions {
  int planes = 260;  // 1 .. 4096; the paper takes 60 to 260
  int iterations = 15;
  double angle_weight = 100;
  double centre_weight = 0;  // > 0: compact billboards, fewer layers, more error of cover
  std::uint64_t seed = 1;
};

struct LeafPlane {
  Vec3 centre{0};
  Vec3 normal{0, 0, 1};
  std::vector<std::uint32_t> leaves;  // ascending
};

// Planes without leaves are seeded anew from the leaf that fits worst; those that end empty are left out.
// Every leaf is in one plane. Same bytes for any number of threads. Throws Error(kInvalidInput) for options
// out of range or no leaves.
std::vector<LeafPlane> cluster_leaves(std::span<const FoliageElement> foliage, const ClusterOptions& options,
                                      const RunControl& control = {});

}  // namespace sunfleck
