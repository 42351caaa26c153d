#include "lighting/render/raster_gather.h"

#include <algorithm>
#include <cmath>

#include "lighting/trace/low_discrepancy.h"
#include "lighting/trace/surface_sampler.h"

namespace sunfleck {
namespace {

constexpr double kGroundSpacing_m = 0.75, kStemSpacing_m = 0.75;
constexpr double kSpacingPerMetre = 0.04;  // of the ground's nodes, at a distance from the camera
constexpr double kThickest_m = 0.03, kLeafReach_m = 2.0;
constexpr std::uint32_t kGroundRays = 48, kStemRays = 16;
constexpr int kAround = 4;

std::uint64_t key_of(std::uint64_t kind, std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  return mix_seed(mix_seed(mix_seed(kind, a), b), c);
}

double distance_to(const Box& box, const Vec3& p) {
  return std::hypot(std::max({0.0, box.lo.x - p.x, p.x - box.hi.x}),
                    std::max({0.0, box.lo.y - p.y, p.y - box.hi.y}));
}

// Foliage clusters of a prototype: flat ones of leaves and round ones of shoots.
bool is_foliage(const PrototypeFigures& f, const FigureCluster& c) {
  return c.flat ? f.flats[c.first].kind == HitKind::kFoliage : f.rounds[c.first].extinction_per_m > 0.0f;
}

}  // namespace

template <class Value>
template <class Find>
Value GatheredLight::Kept<Value>::get(std::uint64_t key, const Find& find) {
  Part& part = parts_[key >> 58];
  {
    const std::lock_guard lock(part.lock);
    if (const auto found = part.values.find(key); found != part.values.end()) return found->second;
  }
  const Value value = find();
  const std::lock_guard lock(part.lock);
  return part.values.try_emplace(key, value).first->second;
}

GatheredLight::GatheredLight(const ShadingParts& parts, const Shader& shader, const FigureTable& table)
    : parts_(parts), shader_(shader), table_(table) {
  const Forest& forest = parts.scene.forest();
  lattice_m_ = Vec2(kGroundSpacing_m);
  if (forest.period) {  // a power of two of steps per period, so that coarser lattices repeat too
    const Vec2 size = forest.period->size_m;
    lattice_m_ = size / Vec2(std::exp2(std::max(0.0, std::round(std::log2(size.x / kGroundSpacing_m)))),
                             std::exp2(std::max(0.0, std::round(std::log2(size.y / kGroundSpacing_m)))));
  }
  for (std::uint32_t p = 0; p < forest.prototypes.size(); ++p) {
    find_leaves(forest.prototypes[p], table.of(PrototypeId{p}));
    share_stems(forest.prototypes[p]);
  }
}

// The nearest leaves of a cluster of wood serve all its segments.
void GatheredLight::find_leaves(const Prototype& prototype, const PrototypeFigures& figures) {
  std::vector<std::uint32_t>& near = leaves_near_.emplace_back(prototype.wood.size(), 0u);
  for (const FigureCluster& wood : figures.clusters) {
    if (wood.flat || is_foliage(figures, wood)) continue;
    std::uint32_t nearest = 0;
    float distance = static_cast<float>(kLeafReach_m) + wood.radius;
    for (std::uint32_t c = 0; c < figures.clusters.size(); ++c) {
      const FigureCluster& leaves = figures.clusters[c];
      const float d = glm::length(leaves.centre - wood.centre);
      if (d < distance && is_foliage(figures, leaves)) distance = d, nearest = c + 1;
    }
    for (std::uint32_t i = wood.first; i < wood.first + wood.count; ++i)
      near[figures.rounds[i].local] = nearest;
  }
}

void GatheredLight::share_stems(const Prototype& prototype) {
  std::unordered_map<std::uint64_t, std::uint32_t> first;  // thick segment of each cube
  std::vector<std::uint32_t>& shares = stem_of_.emplace_back();
  for (std::uint32_t i = 0; i < prototype.wood.size(); ++i) {
    const WoodSegment& s = prototype.wood[i];
    shares.push_back(i);
    if (glm::length(Vec3(s.to_m) - Vec3(s.from_m)) > kStemSpacing_m) continue;
    const Vec3 cube = glm::floor(0.5 * (Vec3(s.from_m) + Vec3(s.to_m)) / kStemSpacing_m);
    const auto whole = [](double v) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(v)); };
    shares.back() =
        first.try_emplace(key_of(whole(cube.x), whole(cube.y), whole(cube.z), 0), i).first->second;
  }
}

GatheredLight::Node GatheredLight::gather(const RayHit& from, std::uint64_t key, std::uint32_t rays) const {
  const trace::ScrambledPoints points(key);
  Vec3 sum(0.0);
  std::uint32_t open = 0;
  for (std::uint32_t i = 0; i < rays; ++i) {
    const auto number = points(i);
    const Vec3 direction = trace::cosine_direction(from.normal, number[0], number[1]);
    const RayHit met = parts_.scene.closest_hit(from.on_original_m, direction,
                                                {from.kind, from.front, from.instance, from.local});
    if (met.kind == HitKind::kWood && !met.front) continue;  // the node lies inside this wood
    sum += shader_.gathered(met, from.on_original_m, direction);
    ++open;
  }
  if (open == 0) return {};
  return {kPi / open * sum, static_cast<double>(open) / rays};
}

GatheredLight::Node GatheredLight::ground_node(std::uint64_t level, std::int64_t x, std::int64_t y,
                                               const Vec2& spacing_m) const {
  const Forest& forest = parts_.scene.forest();
  RayHit at;
  at.kind = HitKind::kGround;
  at.front = true;
  at.normal = forest.terrain.normal();
  const Vec2 origin = forest.period ? forest.period->origin_m : Vec2(0.0);
  const Vec2 place = origin + Vec2(x, y) * spacing_m;
  at.position_m = at.on_original_m = {place.x, place.y, forest.terrain.height_at(place.x, place.y)};
  return gather(at, key_of(level, static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y), 1),
                kGroundRays);
}

Vec3 GatheredLight::on_ground(const Vec3& p, double pixel_m, double distance_m) {
  const Forest& forest = parts_.scene.forest();
  if (parts_.scene.box().empty())
    return nodes_.get(key_of(0, 0, 0, 0), [&] { return ground_node(0, 0, 0, lattice_m_); }).irradiance_w_m2;
  const double beside = forest.period ? 0.0 : distance_to(parts_.scene.box(), p);
  const double wanted = std::max({2.0 * pixel_m, 0.1 * beside, kSpacingPerMetre * distance_m});
  double level = std::max(0.0, std::floor(std::log2(wanted / lattice_m_.x)));
  if (forest.period)  // at least eight steps
    level =
        std::min(level, std::max(0.0, std::floor(std::log2(std::min(forest.period->size_m.x / lattice_m_.x,
                                                                    forest.period->size_m.y / lattice_m_.y) /
                                                           8.0))));
  const Vec2 spacing = lattice_m_ * std::exp2(level);
  const auto coarseness = static_cast<std::uint64_t>(level);
  const Vec2 origin = forest.period ? forest.period->origin_m : Vec2(0.0);
  const Vec2 place = (Vec2(p) - origin) / spacing, low = glm::floor(place), rest = place - low;
  Vec3 sum(0.0);
  double weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    auto x = static_cast<std::int64_t>(low.x) + (i & 1), y = static_cast<std::int64_t>(low.y) + (i >> 1);
    if (forest.period) {
      const auto wrapped = [](std::int64_t v, double size, double step) {
        const auto n = static_cast<std::int64_t>(std::round(size / step));
        return ((v % n) + n) % n;
      };
      x = wrapped(x, forest.period->size_m.x, spacing.x), y = wrapped(y, forest.period->size_m.y, spacing.y);
    }
    const Node node =
        nodes_.get(key_of(coarseness, static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y), 0),
                   [&] { return ground_node(coarseness, x, y, spacing); });
    const double weight =
        node.share * ((i & 1) != 0 ? rest.x : 1.0 - rest.x) * ((i >> 1) != 0 ? rest.y : 1.0 - rest.y);
    sum += weight * node.irradiance_w_m2;
    weights += weight;
  }
  return weights > 0.0 ? sum / weights : Vec3(0.0);
}

Vec3 GatheredLight::on_wood(const RayHit& hit) {
  const Forest& forest = parts_.scene.forest();
  if (hit.kind == HitKind::kWood) {
    const Instance& at = forest.instances[hit.instance];
    const WoodSegment& s = forest.prototypes[at.prototype.value].wood[hit.local];
    const std::uint32_t near = leaves_near_[at.prototype.value][hit.local];
    if (near == 0 || at.scale * std::max(s.radius_from_m, s.radius_to_m) > kThickest_m) return stem(hit);
    const AmbientCube cube =
        cubes_.get(key_of(hit.instance, near, 0, 2), [&] { return this->cube(hit.instance, near - 1); });
    Vec3 light(0.0);
    for (int axis = 0; axis < 3; ++axis) {
      const double n = hit.normal[axis];
      light += n * n * cube[static_cast<std::size_t>(2 * axis + (n < 0.0 ? 1 : 0))];
    }
    return light;
  }
  // Of a mesh: per triangle and side.
  return nodes_
      .get(key_of(hit.instance, hit.local, hit.front, 3),
           [&] { return gather(hit, key_of(hit.instance, hit.local, hit.front, 4), kStemRays); })
      .irradiance_w_m2;
}

GatheredLight::AmbientCube GatheredLight::cube(std::uint32_t instance, std::uint32_t leaf_cluster) const {
  const Forest& forest = parts_.scene.forest();
  const Instance& at = forest.instances[instance];
  const PrototypeFigures& figures = table_.of(at.prototype);
  const FigureCluster& cluster = figures.clusters[leaf_cluster];
  AmbientCube cube;
  std::array<double, 6> weights;
  cube.fill(Vec3(0.0)), weights.fill(0.0);
  const auto add = [&](const Vec3& normal, const FaceLight& face) {
    const Vec3 light = shader_.diffuse(face);
    for (std::size_t d = 0; d < 6; ++d) {
      const double cosine = normal[static_cast<int>(d / 2)] * (d % 2 == 0 ? 1.0 : -1.0);
      // A little of every face, so that no direction is without an answer.
      const double weight = 0.01 + std::pow(std::max(0.0, cosine), 2);
      cube[d] += weight * light, weights[d] += weight;
    }
  };
  for (std::uint32_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
    if (!cluster.flat && figures.rounds[i].extinction_per_m == 0.0f) continue;
    if (cluster.flat && figures.flats[i].kind != HitKind::kFoliage) continue;
    RayHit leaf;
    leaf.kind = HitKind::kFoliage;
    leaf.instance = instance;
    leaf.local = cluster.flat ? figures.flats[i].local : figures.rounds[i].local;
    const ElementLight& light = shader_.light_of(leaf);
    Vec3 normal(0.0);  // needles look everywhere
    if (cluster.flat)
      normal = glm::normalize(
          world_direction_from_tree(at, glm::cross(Vec3(figures.flats[i].u), Vec3(figures.flats[i].v))));
    add(normal, light.front);
    add(-normal, light.back);
  }
  for (std::size_t d = 0; d < 6; ++d) cube[d] /= std::max(weights[d], 1e-30);
  return cube;
}

// Nodes around the segment that serves; `on` between two of them, `up` between two rings of a long segment.
Vec3 GatheredLight::stem(const RayHit& hit) {
  const Forest& forest = parts_.scene.forest();
  const Instance& at = forest.instances[hit.instance];
  RayHit from = hit;
  from.kind = HitKind::kWood;
  from.local = stem_of_[at.prototype.value][hit.local];
  const WoodSegment& s = forest.prototypes[at.prototype.value].wood[from.local];
  const Vec3 base = world_from_tree(at, Vec3(s.from_m)), tip = world_from_tree(at, Vec3(s.to_m));
  const double length = glm::length(tip - base);
  if (!(length > 0.0)) return Vec3(0.0);
  const Vec3 axis = (tip - base) / length;
  const Basis around = basis_around(axis);
  const double taper = at.scale * (static_cast<double>(s.radius_to_m) - s.radius_from_m) / length;
  const int rings = std::clamp(static_cast<int>(std::ceil(length / (at.scale * kStemSpacing_m))), 1, 1000);
  const double along =
      std::clamp(glm::dot(hit.on_original_m - base, axis) / length * rings - 0.5, 0.0, rings - 1.0);
  double turn = std::atan2(glm::dot(hit.normal, around.bitangent), glm::dot(hit.normal, around.tangent)) /
                (2.0 * kPi) * kAround;
  if (turn < 0.0) turn += kAround;
  const int ring = static_cast<int>(along), side = static_cast<int>(turn) % kAround;
  const double up = along - ring, on = turn - std::floor(turn);
  Vec3 sum(0.0);
  double weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    const int k = ring + (i & 1), a = (side + (i >> 1)) % kAround;
    double weight = ((i & 1) != 0 ? up : 1.0 - up) * ((i >> 1) != 0 ? on : 1.0 - on);
    if (weight == 0.0) continue;
    const std::uint64_t place =
        static_cast<std::uint64_t>(k) * kAround + static_cast<std::uint64_t>(a) + (hit.front ? 1u << 20 : 0u);
    const std::uint64_t key = key_of(hit.instance, from.local, place, 5);
    const Node node = nodes_.get(key, [&] {
      const double angle = 2.0 * kPi * a / kAround, h = (k + 0.5) / rings * length;
      const Vec3 out = std::cos(angle) * around.tangent + std::sin(angle) * around.bitangent;
      RayHit start = from;
      start.normal = (hit.front ? 1.0 : -1.0) * glm::normalize(out - taper * axis);
      start.on_original_m =
          base + h * axis + (at.scale * static_cast<double>(s.radius_from_m) + taper * h) * out;
      return gather(start, key, kStemRays);
    });
    weight *= node.share;
    sum += weight * node.irradiance_w_m2;
    weights += weight;
  }
  return weights > 0.0 ? sum / weights : Vec3(0.0);
}

}  // namespace sunfleck
