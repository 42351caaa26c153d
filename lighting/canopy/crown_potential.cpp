// See crown_potential.h.
#include "lighting/canopy/crown_potential.h"

#include <algorithm>
#include <cmath>

#include "lighting/canopy/drop_rays.h"
#include "sim/base/contract.h"
#include "sim/base/parallel.h"

namespace sunfleck {

namespace {

constexpr int kMostSurfaces = 20000;  // on one ray

// A tree, and which copy of it.
struct MetTree {
  std::uint32_t instance;
  Vec2 copy;
  bool operator==(const MetTree&) const = default;
};

class ThroughStand {
 public:
  explicit ThroughStand(const StandScene& scene) : scene_(scene) {}

  // The trees a ray meets, each copy once.
  const std::vector<MetTree>& meet(const DropRay& ray) {
    met_.clear();
    Vec3 origin = ray.origin_m, unwrapped = ray.origin_m;
    RayStart from;
    for (int surfaces = 0; surfaces < kMostSurfaces; ++surfaces) {
      const RayHit hit = scene_.rays().closest_hit(origin, ray.direction, 0.0, from);
      if (hit.kind == HitKind::kSky || hit.kind == HitKind::kGround) break;
      unwrapped += hit.distance_m * ray.direction;
      note({hit.instance, copy_of(unwrapped, hit.on_original_m)});
      origin = hit.on_original_m;
      from = is_shoot(hit) ? RayStart{} : RayStart{hit.kind, !hit.front, hit.instance, hit.local};
    }
    return met_;
  }

 private:
  void note(const MetTree& tree) {
    if (std::find(met_.begin(), met_.end(), tree) == met_.end()) met_.push_back(tree);
  }

  Vec2 copy_of(const Vec3& unwrapped_m, const Vec3& original_m) const {
    if (!scene_.ground().periodic) return Vec2(0.0);
    return glm::round((Vec2(unwrapped_m) - Vec2(original_m)) / scene_.ground().size_m());
  }

  bool is_shoot(const RayHit& hit) const {
    if (hit.kind != HitKind::kFoliage) return false;
    const Forest& forest = scene_.forest();
    const PrototypeId id = forest.instances[hit.instance].prototype;
    return forest.prototypes[id.value].foliage[hit.local].shape == ElementShape::kShoot;
  }

  const StandScene& scene_;
  std::vector<MetTree> met_;
};

}  // namespace

ResponseTable crown_potential(const StandScene& scene, const LightSource& source, const DropOptions& options,
                              const RunControl& control) {
  SUNFLECK_EXPECTS(options.rays_on_map.size() == source.size());
  ResponseTable table(ResponseTable::Kind::kAmount, source.size(), scene.forest().instances.size());
  for_each_chunk(source.size(), 1, control, "trees alone", [&](std::size_t d, std::size_t) {
    if (!(options.rays_on_map[d] > 0.0)) return;
    const std::uint64_t seed = mix_seed(mix_seed(options.seed, 0x616c6f6e65), d);
    const DropRays rays(scene, source.to_source[d], source.half_angle(d), options.rays_on_map[d], seed);
    ThroughStand stand(scene);
    const auto quantum = static_cast<float>(rays.quantum_m2());
    table.quantum[d] = rays.quantum_m2();
    for (std::size_t i = 0; i < rays.count(); ++i) {
      if (i % 256 == 0) control.check();
      RandomStream random(seed, i, RandomPurpose::kStandRays, 1);
      const DropRay ray = rays.ray(i, random);
      if (!ray.may_hit) continue;
      for (const MetTree& tree : stand.meet(ray)) table.row(d)[tree.instance] += quantum;
    }
  });
  return table;
}

}  // namespace sunfleck
