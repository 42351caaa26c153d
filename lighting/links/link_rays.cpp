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

Vec3 around(const Vec3& axis, double along, double turn) {
  const Basis basis = basis_around(axis);
  const double across = std::sqrt(std::max(0.0, 1.0 - along * along));
  return glm::normalize(across * (std::cos(turn) * basis.tangent + std::sin(turn) * basis.bitangent) +
                        along * axis);
}

}  // namespace

LoneTree::LoneTree(const Forest& forest, PrototypeId prototype)
    : forest_(alone(forest, prototype)), receivers_(forest_, no_ground_) {}

FaceRays::FaceRays(const trace::SurfaceSampler& surface, bool front, std::size_t face, std::uint64_t seed)
    : surface_(surface), front_(front), face_(face), seed_(seed), points_(mix_seed(seed, face)) {}

LinkRay FaceRays::ray(int k) const {
  const Point4 p = owen_point(static_cast<std::uint32_t>(k), points_);
  // Of these only a shoot takes numbers: where along its axis a needle sits.
  RandomStream random(seed_, face_, RandomPurpose::kRaysFront, 2 * static_cast<std::uint32_t>(k));
  const trace::SurfacePoint at = surface_.sample_at(p[2], p[3], random);
  const double turn = 2.0 * kPi * p[1];
  // A needle turned any way sends its cosine-distributed rays anywhere alike.
  const Vec3 direction = surface_.is_shoot() ? around({0, 0, 1}, 2.0 * p[0] - 1.0, turn)
                                             : around(front_ ? at.normal : -at.normal,
                                                      std::sqrt(std::max(1e-16, 1.0 - p[0])), turn);
  return {at.position_m, direction, surface_.start(at, front_)};
}

LinkRay in_world(const LinkRay& ray, const Forest& forest, std::uint32_t instance) {
  const Instance& place = forest.instances[instance];
  LinkRay turned{world_from_tree(place, ray.origin_m), world_direction_from_tree(place, ray.direction),
                 ray.from};
  turned.from.instance = instance;
  return turned;
}

}  // namespace sunfleck::links
