// Which trees a picture needs: those that the camera may see, those that may shade what it sees, and those
// that may send light there. Decided from boxes alone, before leaves and wood are read, and never too few.
//
// A camera sees what lies in an intersection of half-spaces. A tree shades what is seen only if the hull of
// its box and of the box moved away from the sun down to the ground meets these. From a light map no light
// bounces: what is seen of wood and ground gathers light no farther than gather_reach_m (shader.h), and the
// mean light of wood and ground is that of the nearest trees seen (near_trees). Hence a picture from a light
// map is the same with the trees chosen here as with all.
//
// Path-traced light comes from everywhere: all trees are needed, unless a share of light is given up.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lighting/render/render_config.h"
#include "sim/forest/forest_outline.h"

namespace sunfleck {

// All that a camera may see, as half-spaces; all of space where they are none. Any point seen has
// dot(normal, point) >= offset for each.
class ViewVolume {
 public:
  explicit ViewVolume(const Camera& camera);  // valid
  // Whether the convex hull of the boxes comes within `margin_m` of the volume; may say yes where only the
  // planes' extensions do.
  bool may_meet(std::span<const Box> boxes, double margin_m) const;

 private:
  struct HalfSpace {
    Vec3 normal;
    double offset;
  };
  std::vector<HalfSpace> sides_;
};

// How far a gather ray of a picture from a light map looks: 3 times the height of the forest's box, 50 m at
// least. What lies beyond is at most atan(1/3) = 18 degrees high: a tenth of the light of level ground, where
// nothing nearer stands before it.
double gather_reach_m(const Box& forest);

// The trees whose ground and wood a picture shows nearest: seen, and at most max(50 m, twice the height of
// the forest's box) farther than the nearest seen one. All where the forest repeats.
struct NearTrees {
  std::vector<char> is_near;  // per instance
  Box box;                    // of them
};
NearTrees near_trees(const Camera& camera, const std::vector<Box>& boxes, bool periodic);

struct TreeSelection {
  std::vector<char> trees, prototypes;  // per instance, per prototype: not 0: needed
  std::size_t trees_needed = 0, prototypes_needed = 0, trees_seen = 0;
  std::string reason;      // what else than the trees seen is needed and why
  double light_bound = 0;  // largest change of the light of a surface, as a share of what an open place gets;
                           // 0: the picture is the same
};
// `far_light` (path-traced only): share of the light of the surroundings that may be given up, [0, 0.5]; 0
// keeps all trees. With it trees are left out that stand farther than D = H / tan(far_light pi / 2) from all
// that is seen, H the height of the forest's box, and do not shade what lies nearer: they take elevations up
// to a = atan(H / D), of which an upright face gets (a + sin a cos a) / pi <= 2 a / pi = far_light of its
// light (level ground sin^2 a, less). Instances and prototypes are needed whole.
TreeSelection trees_for_picture(const ForestOutline& forest, const std::vector<Material>& materials,
                                const RenderRequest& request, RenderMode mode, double far_light);

}  // namespace sunfleck
