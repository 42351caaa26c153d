#include "lighting/render/mean_light.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "lighting/render/seen_trees.h"
#include "lighting/render/shader.h"
#include "lighting/trace/surface_sampler.h"

namespace sunfleck {
namespace {

constexpr int kRounds = 3;
constexpr std::uint64_t kPoints = 1024;  // of ground, wood and leaves each, per round
constexpr std::uint64_t kGroundSeed = 0x67726F756E64, kWoodSeed = 0x776F6F64, kLeafSeed = 0x6C656166;

// Picks an entry in proportion to its weight.
class Lot {
 public:
  void add(double weight) { up_to_.push_back((up_to_.empty() ? 0.0 : up_to_.back()) + weight); }
  bool empty() const { return up_to_.empty() || !(up_to_.back() > 0.0); }
  std::size_t pick(double number) const {
    const auto found = std::upper_bound(up_to_.begin(), up_to_.end(), number * up_to_.back());
    return std::min(static_cast<std::size_t>(found - up_to_.begin()), up_to_.size() - 1);
  }

 private:
  std::vector<double> up_to_;
};

double side_area(const WoodSegment& s) {
  return kPi * glm::length(Vec3(s.to_m) - Vec3(s.from_m)) * (s.radius_from_m + s.radius_to_m);
}

// Draws places of a forest: first the instance, then the part of its prototype.
struct Places {
  const Forest& forest;
  Box ground;
  std::vector<Lot> wood_of, leaf_of;  // per prototype
  Lot wood, leaves;                   // instances

  Places(const Forest& f, const NearTrees& near)
      : forest(f), ground(near.box), wood_of(f.prototypes.size()), leaf_of(f.prototypes.size()) {
    std::vector<double> wood_m2(f.prototypes.size()), leaf_m2(f.prototypes.size());
    for (std::size_t p = 0; p < f.prototypes.size(); ++p) {
      for (const WoodSegment& s : f.prototypes[p].wood)
        wood_of[p].add(side_area(s)), wood_m2[p] += side_area(s);
      for (const FoliageElement& e : f.prototypes[p].foliage)
        leaf_of[p].add(e.area_m2), leaf_m2[p] += e.area_m2;
    }
    for (std::size_t n = 0; n < f.instances.size(); ++n) {
      const Instance& i = f.instances[n];
      const double counts = near.is_near[n] ? 1.0 : 0.0;
      wood.add(counts * wood_m2[i.prototype.value] * i.scale * i.scale);
      leaves.add(counts * leaf_m2[i.prototype.value] * i.scale * i.scale);
    }
  }

  RayHit ground_point(RandomStream& random) const {
    const Vec2 lo = forest.period ? forest.period->origin_m : Vec2(ground.lo);
    const Vec2 size = forest.period ? forest.period->size_m : Vec2(ground.size());
    const double x = random.uniform(), y = random.uniform();
    const Vec2 at = lo + size * Vec2(x, y);
    RayHit hit;
    hit.kind = HitKind::kGround;
    hit.front = true;
    hit.normal = forest.terrain.normal();
    hit.position_m = hit.on_original_m = {at.x, at.y, forest.terrain.height_at(at.x, at.y)};
    return hit;
  }

  RayHit wood_point(RandomStream& random) const {
    RayHit hit;
    hit.kind = HitKind::kWood;
    hit.front = true;
    hit.instance = static_cast<std::uint32_t>(wood.pick(random.uniform()));
    const Instance& at = forest.instances[hit.instance];
    hit.local = static_cast<std::uint32_t>(wood_of[at.prototype.value].pick(random.uniform()));
    const WoodSegment& s = forest.prototypes[at.prototype.value].wood[hit.local];
    const Vec3 axis = Vec3(s.to_m) - Vec3(s.from_m);
    const Basis around = basis_around(glm::normalize(axis));
    const double along = random.uniform(), turn = 2.0 * kPi * random.uniform();
    const Vec3 out = std::cos(turn) * around.tangent + std::sin(turn) * around.bitangent;
    const double radius_m =
        std::lerp(static_cast<double>(s.radius_from_m), static_cast<double>(s.radius_to_m), along);
    hit.normal = world_direction_from_tree(at, out);
    hit.position_m = hit.on_original_m = world_from_tree(at, Vec3(s.from_m) + along * axis + radius_m * out);
    return hit;
  }

  // The middle of a leaf, on either face.
  RayHit leaf_point(RandomStream& random) const {
    RayHit hit;
    hit.kind = HitKind::kFoliage;
    hit.front = random.below(2) == 0;
    hit.instance = static_cast<std::uint32_t>(leaves.pick(random.uniform()));
    const Instance& at = forest.instances[hit.instance];
    hit.local = static_cast<std::uint32_t>(leaf_of[at.prototype.value].pick(random.uniform()));
    const FoliageElement& e = forest.prototypes[at.prototype.value].foliage[hit.local];
    const Vec3 normal = e.shape == ElementShape::kShoot ? trace::any_direction(random)
                                                        : world_direction_from_tree(at, element_normal(e));
    hit.normal = hit.front ? normal : -normal;
    hit.position_m = hit.on_original_m = world_from_tree(at, Vec3(e.centre_m));
    return hit;
  }
};

template <class Draw>
Vec3 mean_irradiance(const Shader& shader, std::uint64_t seed, const Draw& draw) {
  Vec3 sum(0.0);
  for (std::uint64_t i = 0; i < kPoints; ++i) {
    RandomStream random(seed, i, RandomPurpose::kCamera);
    const RayHit hit = draw(random);
    PathSamples numbers(seed, i, 1, 0);
    sum += shader.irradiance(hit, numbers);
  }
  return sum / static_cast<double>(kPoints);
}

// What leaves, wood and ground send to leaves, in the channels of each of two shaders, by the same rays.
Vec3 scattered_ratio(const Shader& colours, const Shader& grey, const ShadingParts& parts,
                     const Places& places) {
  Vec3 coloured(0.0), plain(0.0);
  for (std::uint64_t i = 0; i < 2 * kPoints; ++i) {
    RandomStream random(kLeafSeed, i, RandomPurpose::kCamera);
    const RayHit leaf = places.leaf_point(random);
    const Vec3 direction = trace::cosine_direction(leaf.normal, random);
    const RayHit met = parts.scene.closest_hit(leaf.on_original_m, direction,
                                               {leaf.kind, leaf.front, leaf.instance, leaf.local});
    if (met.kind == HitKind::kSky || met.distance_m > parts.gather_reach_m) continue;
    coloured += colours.gathered(met, leaf.on_original_m, direction);
    plain += grey.gathered(met, leaf.on_original_m, direction);
  }
  for (int c = 0; c < 3; ++c) coloured[c] = plain[c] > 0.0 ? coloured[c] / plain[c] : 1.0;
  return coloured;
}

}  // namespace

MeanLight find_mean_light(const ShadingParts& parts, const ShadingParts& grey_parts, const NearTrees& near) {
  const Places places(parts.scene.forest(), near);
  MeanLight mean, grey_mean;
  mean.ground_w_m2 = mean.wood_w_m2 = parts.light.open_ground();
  grey_mean.ground_w_m2 = grey_mean.wood_w_m2 = grey_parts.light.open_ground();
  if (near.box.empty()) return mean;
  for (int round = 0; round < kRounds; ++round) {
    const Shader shader(parts, mean), grey(grey_parts, grey_mean);
    if (!places.leaves.empty()) mean.scatter_tint = scattered_ratio(shader, grey, parts, places);
    for (const auto& [from, to] : {std::pair{&shader, &mean}, std::pair{&grey, &grey_mean}}) {
      to->ground_w_m2 = mean_irradiance(*from, kGroundSeed,
                                        [&](RandomStream& random) { return places.ground_point(random); });
      if (!places.wood.empty())
        to->wood_w_m2 = mean_irradiance(*from, kWoodSeed,
                                        [&](RandomStream& random) { return places.wood_point(random); });
    }
  }
  return mean;
}

}  // namespace sunfleck
