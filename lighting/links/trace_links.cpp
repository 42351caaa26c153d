#include "lighting/links/trace_links.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "lighting/links/link_ends.h"
#include "lighting/links/link_memory.h"
#include "lighting/trace/visiting_order.h"
#include "sim/base/parallel.h"

namespace sunfleck::links {
namespace {

using trace::Receivers;
using trace::SurfaceSampler;

std::uint32_t end_of(const Receivers& receivers, const RayHit& hit, const Vec3& direction) {
  return hit.kind == HitKind::kSky ? sky_end(direction) : receivers.met_by(hit);
}

bool gives_light_back(const Receivers& receivers, std::uint32_t end) { return end < receivers.sky(); }

// Puts the ends that are faces first, keeping their order; returns how many there are.
std::uint16_t faces_first(const Receivers& receivers, std::span<std::uint32_t> ends) {
  const auto after = std::stable_partition(
      ends.begin(), ends.end(), [&](std::uint32_t end) { return gives_light_back(receivers, end); });
  return static_cast<std::uint16_t>(after - ends.begin());
}

bool is_on_tree(const RayHit& hit) { return hit.kind != HitKind::kSky && hit.kind != HitKind::kGround; }

// The face of its own tree that a hit lies on, as the tree alone numbers them.
std::uint32_t own_face(const LoneTree& tree, RayHit hit) {
  hit.instance = 0;
  return tree.receivers().met_by(hit);
}

// Calls visit(surface, side, face) for every face of the tree, neighbours in space one after the other.
using FaceVisit = std::function<void(const SurfaceSampler&, bool front, std::size_t face)>;
void for_each_face(const LoneTree& tree, const RunControl& control, const FaceVisit& visit) {
  const std::vector<std::uint32_t> order = trace::visiting_order(tree.receivers());
  for_each_chunk(order.size(), 8, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const SurfaceSampler surface(tree.receivers(), order[i]);
      for (std::size_t side = 0; side < 2; ++side) {
        control.check();
        visit(surface, side == 0, 2 * std::size_t{order[i]} + side);
      }
    }
  });
}

TreeLinks empty_links(const LoneTree& tree, std::size_t links, bool stands_once) {
  TreeLinks t;
  t.foliage = static_cast<std::uint32_t>(tree.receivers().foliage_count());
  t.wood = static_cast<std::uint32_t>(tree.receivers().wood_count());
  t.stands_once = stands_once;
  t.rows.resize(t.faces() * links);
  t.leaf_hits.resize(t.faces());
  t.own_hits.resize(t.faces());
  for (const FoliageElement& e : tree.forest().prototypes[0].foliage)
    t.is_shoot.push_back(e.shape == ElementShape::kShoot);
  return t;
}

class Tracer {
 public:
  Tracer(const LinkScene& scene, LinkTable& table, std::uint64_t seed, const RunControl& control)
      : scene_(scene),
        table_(table),
        seed_(seed),
        links_(static_cast<std::size_t>(table.links_per_face)),
        control_(control) {}

  // Of a prototype whose only instance this is: straight through the forest.
  void trace_only_instance(const LoneTree& tree, std::uint32_t instance) {
    TreeLinks& t = tree_links(instance);
    t = empty_links(tree, links_, true);
    InstanceEnds& out = table_.beyond[instance];
    out.faces_met.resize(t.faces());
    for_each_face(tree, control_, [&](const SurfaceSampler& surface, bool front, std::size_t face) {
      Row row;
      const FaceRays rays(surface, front, face, tree_seed(instance));
      for (std::size_t k = 0; k < links_; ++k) {
        const LinkRay ray = in_world(rays.ray(static_cast<int>(k)), scene_.forest, instance);
        const RayHit hit = scene_.rays.closest_hit(ray.origin_m, ray.direction, 0.0, ray.from);
        if (is_on_tree(hit) && hit.instance == instance)
          row.add_own(t, own_face(tree, hit));
        else
          row.beyond.push_back(end_of(scene_.receivers, hit, ray.direction));
      }
      out.faces_met[face] = faces_first(scene_.receivers, row.beyond);
      row.store(t, face, links_);
    });
  }

  // Of a prototype that stands more than once: alone. Ends are the numbers of the rays that leave.
  void trace_alone(const LoneTree& tree, std::uint32_t first_instance) {
    TreeLinks& t = tree_links(first_instance);
    t = empty_links(tree, links_, false);
    const RayScene scene(tree.forest(), {.ground = false}, control_);
    for_each_face(tree, control_, [&](const SurfaceSampler& surface, bool front, std::size_t face) {
      Row row;
      const FaceRays rays(surface, front, face, tree_seed(first_instance));
      for (std::size_t k = 0; k < links_; ++k) {
        const LinkRay ray = rays.ray(static_cast<int>(k));
        const RayHit hit = scene.closest_hit(ray.origin_m, ray.direction, 0.0, ray.from);
        if (hit.kind == HitKind::kSky)
          row.beyond.push_back(static_cast<std::uint32_t>(k));
        else
          row.add_own(t, own_face(tree, hit));
      }
      row.store(t, face, links_);
    });
    t.first_exit.assign(1, 0);
    for (std::size_t face = 0; face < t.faces(); ++face)
      t.first_exit.push_back(t.first_exit.back() + links_ - t.own_hits[face]);
  }

  // The rays of such a tree that leave it, from one of its instances.
  void trace_exits(const LoneTree& tree, std::uint32_t instance) {
    const TreeLinks& t = tree_links(instance);
    InstanceEnds& out = table_.beyond[instance];
    out.ends.resize(t.first_exit.back());
    out.faces_met.resize(t.faces());
    for_each_face(tree, control_, [&](const SurfaceSampler& surface, bool front, std::size_t face) {
      const FaceRays rays(surface, front, face, tree_seed(instance));
      const std::uint32_t* leaving = t.rows.data() + face * links_ + t.own_hits[face];
      const std::span<std::uint32_t> ends(out.ends.data() + t.first_exit[face], links_ - t.own_hits[face]);
      for (std::size_t i = 0; i < ends.size(); ++i) {
        const LinkRay ray = in_world(rays.ray(static_cast<int>(leaving[i])), scene_.forest, instance);
        ends[i] = end_of(scene_.receivers, beyond_own_tree(ray, instance), ray.direction);
      }
      out.faces_met[face] = faces_first(scene_.receivers, ends);
    });
  }

  void trace_ground() {
    const Receivers& r = scene_.receivers;
    InstanceEnds& out = table_.ground;
    out.ends.resize(r.ground().count() * links_);
    out.faces_met.resize(r.ground().count());
    for_each_chunk(r.ground().count(), 16, control_, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t cell = begin; cell < end; ++cell) {
        control_.check();
        const SurfaceSampler surface(r, r.two_faced_count() + cell);
        const FaceRays rays(surface, true, cell, mix_seed(seed_, kGroundSeed));
        const std::span<std::uint32_t> row(out.ends.data() + cell * links_, links_);
        for (std::size_t k = 0; k < links_; ++k) {
          const LinkRay ray = rays.ray(static_cast<int>(k));
          row[k] =
              end_of(r, scene_.rays.closest_hit(ray.origin_m, ray.direction, 0.0, ray.from), ray.direction);
        }
        out.faces_met[cell] = faces_first(r, row);
      }
    });
  }

 private:
  static constexpr std::uint64_t kGroundSeed = ~std::uint64_t{0};

  // A row while it is filled.
  struct Row {
    std::vector<std::uint32_t> leaves, wood, beyond;
    void add_own(const TreeLinks& t, std::uint32_t face) {
      if (face < 2 * t.foliage)
        leaves.push_back(face);
      else
        wood.push_back(face - 2 * t.foliage);
    }
    void store(TreeLinks& t, std::size_t face, std::size_t links) const {
      auto at = t.rows.begin() + static_cast<std::ptrdiff_t>(face * links);
      for (const auto* part : {&leaves, &wood, &beyond}) at = std::copy(part->begin(), part->end(), at);
      t.leaf_hits[face] = static_cast<std::uint16_t>(leaves.size());
      t.own_hits[face] = static_cast<std::uint16_t>(leaves.size() + wood.size());
    }
  };

  TreeLinks& tree_links(std::uint32_t instance) {
    return table_.trees[scene_.forest.instances[instance].prototype.value];
  }
  // Every prototype draws its own numbers, wherever it stands.
  std::uint64_t tree_seed(std::uint32_t instance) const {
    return mix_seed(seed_, scene_.forest.instances[instance].prototype.value);
  }

  // True if the hit lies on the instance itself, not on a copy of it in another period.
  bool is_own(const RayHit& hit, const LinkRay& ray, std::uint32_t instance) const {
    if (!is_on_tree(hit) || hit.instance != instance) return false;
    if (!scene_.forest.period) return true;
    const Vec3 away = hit.on_original_m - (ray.origin_m + hit.distance_m * ray.direction);
    const Vec2 size = scene_.forest.period->size_m;
    return std::abs(away.x) < 0.5 * size.x && std::abs(away.y) < 0.5 * size.y;
  }

  RayHit beyond_own_tree(const LinkRay& ray, std::uint32_t instance) const {
    constexpr int kMostHits = 1000;
    double from_m = 0.0;
    for (int i = 0;; ++i) {
      const RayHit hit = scene_.rays.closest_hit(ray.origin_m, ray.direction, from_m, ray.from);
      if (i == kMostHits || !is_own(hit, ray, instance)) return hit;
      from_m = hit.distance_m * (1.0 + 1e-6) + 1e-9;
    }
  }

  const LinkScene& scene_;
  LinkTable& table_;
  const std::uint64_t seed_;
  const std::size_t links_;
  const RunControl& control_;
};

LinkTable empty_table(const LinkScene& scene, int links_per_face) {
  LinkTable table;
  table.links_per_face = links_per_face;
  table.trees.resize(scene.forest.prototypes.size());
  table.beyond.resize(scene.forest.instances.size());
  std::size_t wood = 2 * scene.receivers.foliage_count();
  for (std::size_t i = 0; i < scene.forest.instances.size(); ++i) {
    const std::uint32_t prototype = scene.forest.instances[i].prototype.value;
    const Prototype& p = scene.forest.prototypes[prototype];
    table.instances.push_back({prototype, 2 * scene.receivers.index().first_element(i), wood});
    wood += 2 * (trace::group_wood(p).count() + p.wood_mesh.size());
  }
  return table;
}

std::uint64_t exit_bytes(const TreeLinks& tree) {
  return tree.first_exit.empty() ? 0 : 4 * tree.first_exit.back() + 2 * tree.faces();
}

}  // namespace

LinkTable trace_links(const LinkScene& scene, int links_per_face, std::uint64_t seed,
                      std::uint64_t memory_limit_bytes, const RunControl& control) {
  LinkTable table = empty_table(scene, links_per_face);
  Tracer tracer(scene, table, seed, control);
  const std::vector<std::vector<std::uint32_t>> stands = instances_of_prototypes(scene.forest);
  std::vector<std::unique_ptr<LoneTree>> trees(stands.size());
  const double steps = static_cast<double>(stands.size() + scene.forest.instances.size());
  double done = 0.0;
  const auto step = [&] { control.report("tracing links", ++done / steps); };
  std::uint64_t bytes = fewest_bytes(scene.receivers, links_per_face);
  for (std::size_t p = 0; p < stands.size(); ++p, step()) {
    if (stands[p].empty()) continue;
    trees[p] = std::make_unique<LoneTree>(scene.forest, PrototypeId{static_cast<std::uint32_t>(p)});
    if (stands[p].size() == 1)
      tracer.trace_only_instance(*trees[p], stands[p][0]);
    else
      tracer.trace_alone(*trees[p], stands[p][0]);
    bytes += stands[p].size() * exit_bytes(table.trees[p]);
    check_memory(bytes, links_per_face, memory_limit_bytes);
  }
  for (std::size_t p = 0; p < stands.size(); ++p)
    for (const std::uint32_t instance : stands[p]) {
      if (stands[p].size() > 1) tracer.trace_exits(*trees[p], instance);
      step();
    }
  tracer.trace_ground();
  return table;
}

}  // namespace sunfleck::links
