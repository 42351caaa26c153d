#include "lighting/render/raster_gather.h"

#include <algorithm>
#include <cmath>

#include "lighting/trace/low_discrepancy.h"
#include "lighting/trace/surface_sampler.h"

namespace sunfleck {
namespace {

constexpr double kGroundSpacing_m = 0.75, kStemSpacing_m = 0.5;
constexpr double kThickest_m = 0.03, kLeafReach_m = 0.6;
constexpr std::uint32_t kGroundRays = 64, kStemRays = 32;
constexpr int kAround = 6;

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
  if (forest.period)  // a whole number of steps per period
    lattice_m_ = forest.period->size_m / glm::max(Vec2(1.0), glm::round(forest.period->size_m / lattice_m_));
  for (std::uint32_t p = 0; p < forest.prototypes.size(); ++p) {
    const PrototypeFigures& figures = table.of(PrototypeId{p});
    std::vector<std::uint32_t>& near = leaves_near_.emplace_back(forest.prototypes[p].wood.size(), 0u);
    for (const FigureCluster& wood : figures.clusters) {
      if (wood.flat) continue;
      // The nearest leaves of a cluster of wood serve all its segments.
      std::uint32_t nearest = 0;
      float distance = static_cast<float>(kLeafReach_m) + wood.radius;
      for (std::uint32_t c = 0; c < figures.clusters.size(); ++c) {
        const FigureCluster& leaves = figures.clusters[c];
        const float d = glm::length(leaves.centre - wood.centre);
        if (d < distance && is_foliage(figures, leaves)) distance = d, nearest = c + 1;
      }
      for (std::uint32_t i = wood.first; i < wood.first + wood.count; ++i)
        if (figures.rounds[i].extinction_per_m == 0.0f) near[figures.rounds[i].local] = nearest;
    }
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
    sum += shader_.gathered(met, direction);
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

Vec3 GatheredLight::on_ground(const Vec3& p, double pixel_m) {
  const Forest& forest = parts_.scene.forest();
  if (parts_.scene.box().empty())
    return nodes_.get(key_of(0, 0, 0, 0), [&] { return ground_node(0, 0, 0, lattice_m_); }).irradiance_w_m2;
  std::uint64_t level = 0;
  Vec2 spacing = lattice_m_;
  if (!forest.period) {
    const double wanted = std::max(2.0 * pixel_m, 0.1 * distance_to(parts_.scene.box(), p));
    level = static_cast<std::uint64_t>(std::max(0.0, std::floor(std::log2(wanted / spacing.x))));
    spacing *= std::exp2(static_cast<double>(level));
  }
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
        nodes_.get(key_of(level, static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y), 0),
                   [&] { return ground_node(level, x, y, spacing); });
    const double weight = node.share * ((i & 1) != 0 ? rest.x : 1.0 - rest.x) *
                          ((i >> 1) != 0 ? rest.y : 1.0 - rest.y);
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
           [&] {
             return gather(hit, key_of(hit.instance, hit.local, hit.front, 4), kStemRays);
           })
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
      normal = glm::normalize(world_direction_from_tree(
          at, glm::cross(Vec3(figures.flats[i].u), Vec3(figures.flats[i].v))));
    add(normal, light.front);
    add(-normal, light.back);
  }
  for (std::size_t d = 0; d < 6; ++d) cube[d] /= std::max(weights[d], 1e-30);
  return cube;
}

Vec3 GatheredLight::stem(const RayHit& hit) {
  const Forest& forest = parts_.scene.forest();
  const Instance& at = forest.instances[hit.instance];
  const WoodSegment& s = forest.prototypes[at.prototype.value].wood[hit.local];
  const Vec3 base = world_from_tree(at, Vec3(s.from_m)), tip = world_from_tree(at, Vec3(s.to_m));
  const double length = glm::length(tip - base);
  const Vec3 axis = (tip - base) / length;
  const Basis around = basis_around(axis);
  const double taper = at.scale * (static_cast<double>(s.radius_to_m) - s.radius_from_m) / length;
  const int steps = std::clamp(static_cast<int>(std::ceil(length / kStemSpacing_m)), 1, 1000);
  const Vec3 from_base = hit.on_original_m - base;
  const double along = std::clamp(glm::dot(from_base, axis) / length, 0.0, 1.0) * steps;
  // The side that was seen: inside an open stem the normal looks at the axis.
  double turn = std::atan2(glm::dot(hit.normal, around.bitangent), glm::dot(hit.normal, around.tangent)) /
                (2.0 * kPi) * kAround;
  if (turn < 0.0) turn += kAround;
  const int step = std::min(static_cast<int>(along), steps - 1), side = static_cast<int>(turn) % kAround;
  const double up = along - step, on = turn - std::floor(turn);
  Vec3 sum(0.0);
  double weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    const int k = step + (i & 1), a = (side + (i >> 1)) % kAround;
    const std::uint64_t place =
        static_cast<std::uint64_t>(k) * kAround + static_cast<std::uint64_t>(a) + (hit.front ? 1u << 20 : 0u);
    const std::uint64_t key = key_of(hit.instance, hit.local, place, 5);
    const Node node = nodes_.get(key, [&] {
      const double angle = 2.0 * kPi * a / kAround;
      const Vec3 out = std::cos(angle) * around.tangent + std::sin(angle) * around.bitangent;
      // Nodes at the ends are drawn in a little, so that they do not lie in the next segment.
      const double h = std::clamp(static_cast<double>(k) / steps, 0.1, 0.9) * length;
      RayHit from = hit;
      from.normal = glm::normalize(out - taper * axis);
      const double radius = at.scale * static_cast<double>(s.radius_from_m) + taper * h;
      from.on_original_m = base + h * axis + (hit.front ? radius : -radius) * out;
      return gather(from, key, kStemRays);
    });
    const double weight =
        node.share * ((i & 1) != 0 ? up : 1.0 - up) * ((i >> 1) != 0 ? on : 1.0 - on);
    sum += weight * node.irradiance_w_m2;
    weights += weight;
  }
  return weights > 0.0 ? sum / weights : Vec3(0.0);
}

}  // namespace sunfleck
