#include "sim/forest/forest_outline.h"

#include <algorithm>

namespace sunfleck {
namespace {

double extent_m(const FoliageElement& e) {
  return 2.0 * (glm::length(Vec3(e.half_u_m)) + glm::length(Vec3(e.half_v_m)));
}

}  // namespace

PrototypeOutline outline_of(const Prototype& prototype) {
  PrototypeOutline outline{prototype_bounds(prototype), prototype_reach_m(prototype), 0.0,
                           prototype.foliage.size()};
  for (const FoliageElement& e : prototype.foliage)
    outline.longest_leaf_m = std::max(outline.longest_leaf_m, extent_m(e));
  return outline;
}

ForestOutline outline_of(const Forest& forest) {
  ForestOutline outline{{}, forest.instances, forest.terrain, forest.period};
  for (const Prototype& prototype : forest.prototypes) outline.prototypes.push_back(outline_of(prototype));
  return outline;
}

Box instance_box(const Instance& instance, const PrototypeOutline& outline) {
  const Box& box = outline.bounds;
  Box bounds;
  if (box.empty()) return bounds;
  for (int corner = 0; corner < 8; ++corner)
    bounds.include(
        world_from_tree(instance, {corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                                   corner & 4 ? box.hi.z : box.lo.z}));
  const double reach_m = static_cast<double>(instance.scale) * outline.reach_m;
  for (int axis = 0; axis < 2; ++axis) {
    bounds.lo[axis] = std::max(bounds.lo[axis], instance.position_m[axis] - reach_m);
    bounds.hi[axis] = std::min(bounds.hi[axis], instance.position_m[axis] + reach_m);
  }
  return bounds;
}

std::vector<Box> instance_boxes(const ForestOutline& forest) {
  std::vector<Box> boxes;
  boxes.reserve(forest.instances.size());
  for (const Instance& instance : forest.instances)
    boxes.push_back(instance_box(instance, forest.prototypes[instance.prototype.value]));
  return boxes;
}

}  // namespace sunfleck
