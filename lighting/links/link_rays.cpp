#include "lighting/links/link_rays.h"

#include "lighting/trace/low_discrepancy.h"

namespace sunfleck::links {
namespace {

Forest alone(const Forest& forest, PrototypeId prototype) {
  Forest tree;
  tree.prototypes.push_back(forest.prototypes[prototype.value]);
  tree.instances.push_back({});
  return tree;
}

LinkRay ray_from(const trace::SurfaceSampler& surface, const trace::CubePoint& x, const Vec3& direction,
                 bool front) {
  const trace::SurfacePoint at = surface.sample_at(x[2], x[3], x[4]);
  return {at.position_m, direction, surface.start(at, front)};
}

constexpr int kFewestForMore = 4;  // links of a lobe that more rays than these are cast for

// Both faces' lobes of one half sphere.
class HalfRays {
 public:
  HalfRays(const trace::SurfaceSampler& surface, const Vec3& normal, Half half, int links_per_face,
           std::uint64_t seed)
      : surface_(surface),
        normal_(normal),
        half_(half),
        counts_(counts_of(half, surface.is_shoot(), links_per_face)),
        points_(seed) {}

  void cast(SurfaceRays& out) const {
    for (const Lobe lobe : {lobe_of(half_, true), lobe_of(half_, false)}) {
      out[lobe].weight = lobe_weight(lobe, normal_.z);
      out[lobe].rays.reserve(static_cast<std::size_t>(counts_.cast));
    }
    for (int k = 0; k < counts_.cast; ++k) add(k, out);
    for (const bool front : {true, false}) leave_none_empty(lobe_of(half_, front), out);
    // What was seen, sky or not, needs a link of its own.
    for (const bool front : {true, false}) {
      LobeRays& lobe = out[lobe_of(half_, front)];
      if (lobe.links < kFewestForMore) lobe.rays.resize(static_cast<std::size_t>(lobe.links));
    }
  }

 private:
  void add(int k, SurfaceRays& out) const {
    const trace::CubePoint x = points_(static_cast<std::uint32_t>(k));
    // A needle turned any way sends its cosine-distributed rays anywhere alike. Its faces take turns that
    // leave each of them evenly spread points.
    const LeafDirection d = surface_.is_shoot()
                                ? LeafDirection{even_direction(half_, x[0], x[1]), (k >> 1) % 2 == 0}
                                : leaf_direction(normal_, half_, x[0], x[1]);
    const Lobe lobe = lobe_of(half_, d.front);
    const bool thin = out[lobe].weight == 0.0;  // by rounding: the other face's horizon
    LobeRays& to = out[thin ? other_face(lobe) : lobe];
    to.rays.push_back(ray_from(surface_, x, thin ? mirrored(d.direction) : d.direction, thin != d.front));
    to.links += k < counts_.links ? 1 : 0;
  }

  // A lobe that no kept point fell into gets its first ray, or one more, in place of a link of the other
  // face's.
  void leave_none_empty(Lobe lobe, SurfaceRays& out) const {
    LobeRays& to = out[lobe];
    if (to.links > 0 || to.weight == 0.0 || out[other_face(lobe)].links < 2) return;
    if (to.rays.empty()) {
      const bool front = lobe == kFrontUp || lobe == kFrontDown;
      const trace::CubePoint x = points_(static_cast<std::uint32_t>(counts_.cast));
      to.rays.push_back(
          ray_from(surface_, x, lobe_direction(front ? normal_ : -normal_, half_, x[0], x[1]), front));
    }
    ++to.links;
    --out[other_face(lobe)].links;
  }

  // Through the plane of the leaf.
  Vec3 mirrored(const Vec3& d) const { return d - 2.0 * glm::dot(d, normal_) * normal_; }

  const trace::SurfaceSampler& surface_;
  const Vec3 normal_;
  const Half half_;
  const HalfCounts counts_;
  const trace::ScrambledPoints points_;
};

}  // namespace

LoneTree::LoneTree(const Forest& forest, PrototypeId prototype)
    : forest_(alone(forest, prototype)), receivers_(forest_, no_ground_) {}

SurfaceRays rays_of_surface(const LoneTree& tree, std::size_t s, int links_per_face, std::uint64_t seed) {
  const trace::SurfaceSampler surface(tree.receivers(), s);
  SurfaceRays out;
  if (s >= tree.receivers().foliage_count()) {
    for (const bool front : {true, false})
      out[front ? kFrontUp : kBackUp] = {
          rays_of_face(surface, front, links_per_face, 2 * s + (front ? 0 : 1), seed), links_per_face, 1.0};
    return out;
  }
  const FoliageElement& e = tree.forest().prototypes[0].foliage[s];
  const Vec3 normal =
      e.shape == ElementShape::kShoot ? Vec3(1, 0, 0) : element_normal(e);  // level for a shoot
  for (const Half half : {Half::kUp, Half::kDown})
    HalfRays(surface, normal, half, links_per_face, mix_seed(seed, 2 * s + (half == Half::kUp ? 0 : 1)))
        .cast(out);
  return out;
}

std::vector<LinkRay> rays_of_face(const trace::SurfaceSampler& surface, bool front, int links,
                                  std::size_t key, std::uint64_t seed) {
  const trace::ScrambledPoints points(mix_seed(seed, key));
  std::vector<LinkRay> rays;
  rays.reserve(static_cast<std::size_t>(links));
  for (int k = 0; k < links; ++k) {
    const trace::CubePoint x = points(static_cast<std::uint32_t>(k));
    const trace::SurfacePoint at = surface.sample_at(x[2], x[3], x[4]);
    rays.push_back({at.position_m, trace::cosine_direction(front ? at.normal : -at.normal, x[0], x[1]),
                    surface.start(at, front)});
  }
  return rays;
}

LinkRay in_world(const LinkRay& ray, const Forest& forest, std::uint32_t instance) {
  const Instance& place = forest.instances[instance];
  LinkRay turned{world_from_tree(place, ray.origin_m), world_direction_from_tree(place, ray.direction),
                 ray.from};
  turned.from.instance = instance;
  return turned;
}

}  // namespace sunfleck::links
