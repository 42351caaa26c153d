#include "lighting/links/link_rays.h"

#include <algorithm>
#include <cmath>

#include "lighting/links/owen_points.h"

namespace sunfleck::links {
namespace {

Forest alone(const Forest& forest, PrototypeId prototype) {
  Forest tree;
  tree.prototypes.push_back(forest.prototypes[prototype.value]);
  tree.instances.push_back({});
  return tree;
}

}  // namespace

LoneTree::LoneTree(const Forest& forest, PrototypeId prototype)
    : forest_(alone(forest, prototype)), receivers_(forest_, no_ground_) {}

LobeRays::LobeRays(const trace::SurfaceSampler& surface, std::size_t surface_key, Lobe lobe, Part part,
                   std::uint64_t seed)
    : surface_(surface),
      front_(lobe == kFrontUp || lobe == kFrontDown),
      part_(part),
      key_(kLobes * surface_key + lobe),
      points_(mix_seed(seed, key_)) {}

LinkRay LobeRays::ray(int k) const {
  const Point4 p = owen_point(static_cast<std::uint32_t>(k), points_);
  // Of these only a shoot takes numbers: where along its axis a needle sits.
  RandomStream random(points_, key_, RandomPurpose::kRaysFront, 2 * static_cast<std::uint32_t>(k));
  const trace::SurfacePoint at = surface_.sample_at(p[2], p[3], random);
  // A needle turned any way sends its cosine-distributed rays anywhere alike.
  const Vec3 direction = surface_.is_shoot()
                             ? even_direction(part_, p[0], p[1])
                             : cosine_direction(front_ ? at.normal : -at.normal, part_, p[0], p[1]);
  return {at.position_m, direction, surface_.start(at, front_)};
}

Lobes lobes_of(const LoneTree& tree, std::size_t surface, int links_per_face) {
  if (surface >= tree.receivers().foliage_count()) return whole_lobes(links_per_face);
  const FoliageElement& e = tree.forest().prototypes[0].foliage[surface];
  return leaf_lobes(links_per_face, e.shape == ElementShape::kShoot ? 0.0 : element_normal(e).z);
}

Part part_of(const LoneTree& tree, std::size_t surface, Lobe lobe) {
  if (surface >= tree.receivers().foliage_count()) return Part::kWhole;
  return lobe == kFrontUp || lobe == kBackUp ? Part::kUp : Part::kDown;
}

LinkRay in_world(const LinkRay& ray, const Forest& forest, std::uint32_t instance) {
  const Instance& place = forest.instances[instance];
  LinkRay turned{world_from_tree(place, ray.origin_m), world_direction_from_tree(place, ray.direction),
                 ray.from};
  turned.from.instance = instance;
  return turned;
}

}  // namespace sunfleck::links
