#include "lighting/links/trace_links.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>

#include "lighting/links/link_ends.h"
#include "lighting/links/link_hits.h"
#include "lighting/links/link_memory.h"
#include "lighting/links/link_row.h"
#include "lighting/links/lobe_walk.h"
#include "lighting/links/tree_neighbours.h"
#include "sim/base/parallel.h"

namespace sunfleck::links {
namespace {

using trace::Receivers;
using trace::SurfaceSampler;

// What is known of the rays of a prototype that stands more than once, until all its instances are traced.
struct LoneRays {
  std::vector<std::vector<std::uint16_t>> more_exits;  // per lobe: rays that leave it, of those not kept
  std::vector<float>
      own_m;  // [surface][2 K], as the rows: how far ray k of a lobe flies in the tree; 0: leaves it
};

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
    t = empty_links(tree, table_.links_per_face);
    InstanceEnds& out = table_.beyond[instance];
    make_room(out, t.links.size(), 0);
    for_each_new_lobe(tree, instance, t, [&](const LobePlace& at) {
      LobeRow row(2 * t.foliage);
      std::size_t more_sky = 0;
      const auto ray = [&](int k) { return in_world(at.ray(k), scene_.forest, instance); };
      fill(
          row, at, [&](int k) { return found_from(tree, ray(k), instance); },
          [](const Found& f) { return !f.own && is_sky(f.what); },
          [&](int k) {
            const LinkRay r = ray(k);
            return !scene_.rays.occluded(r.origin_m, r.direction, 0.0, r.from);
          },
          [&](std::uint32_t) { ++more_sky; });
      row.store(t, at, links_);
      const std::size_t own = t.own_hits[at.lobe];
      store_ends(scene_.receivers, {row_of(t, at, links_) + own, static_cast<std::size_t>(at.links()) - own},
                 at.lobe, more_sky, out);
    });
  }

  // Of a prototype that stands more than once: alone. Ends are the numbers of the rays that leave.
  LoneRays trace_alone(const LoneTree& tree, const RayScene& scene, std::uint32_t first_instance) {
    TreeLinks& t = tree_links(first_instance);
    t = empty_links(tree, table_.links_per_face);
    LoneRays lone;
    lone.more_exits.resize(t.links.size());
    lone.own_m.resize(t.rows.size());
    for_each_new_lobe(tree, first_instance, t, [&](const LobePlace& at) {
      LobeRow row(2 * t.foliage);
      float* own_m = lone.own_m.data() + (row_of(t, at, links_) - t.rows.data());
      fill(
          row, at,
          [&](int k) {
            const LinkRay r = at.ray(k);
            const RayHit hit = scene.closest_hit(r.origin_m, r.direction, 0.0, r.from);
            if (hit.kind == HitKind::kSky) return Found{false, static_cast<std::uint32_t>(k)};
            if (k < at.links()) own_m[k] = static_cast<float>(hit.distance_m);
            return Found{true, own_face(tree, hit)};
          },
          [](const Found& f) { return !f.own; },
          [&](int k) {
            const LinkRay r = at.ray(k);
            return !scene.occluded(r.origin_m, r.direction, 0.0, r.from);
          },
          [&](std::uint32_t k) { lone.more_exits[at.lobe].push_back(static_cast<std::uint16_t>(k)); });
      row.store(t, at, links_);
    });
    t.first_exit.assign(1, 0);
    for (std::size_t l = 0; l < t.links.size(); ++l)
      t.first_exit.push_back(t.first_exit.back() + t.links[l] - t.own_hits[l]);
    return lone;
  }

  // The rays of such a tree that leave it, from one of its instances.
  void trace_exits(const LoneTree& tree, const LoneRays& lone, std::uint32_t instance) {
    const TreeLinks& t = tree_links(instance);
    InstanceEnds& out = table_.beyond[instance];
    make_room(out, t.links.size(), t.first_exit.back());
    for_each_lobe(tree, instance, [&](const LobePlace& at) {
      const std::size_t own = t.own_hits[at.lobe], count = static_cast<std::size_t>(at.links()) - own;
      const std::uint32_t* leaving = row_of(t, at, links_) + own;
      const std::span<std::uint32_t> ends(out.ends.data() + t.first_exit[at.lobe], count);
      const auto end_of_ray = [&](std::uint32_t k) {
        const LinkRay ray = in_world(at.ray(static_cast<int>(k)), scene_.forest, instance);
        return end_of(scene_.receivers, beyond(instance, ray, kEndless), ray.direction);
      };
      const auto sees_sky = [&](std::uint32_t k) {
        const LinkRay ray = in_world(at.ray(static_cast<int>(k)), scene_.forest, instance);
        return !scene_.rays.occluded_past(instance, ray.origin_m, ray.direction, ray.from);
      };
      std::size_t skies = 0, more_sky = 0;
      for (std::size_t i = 0; i < count; ++i) skies += is_sky(ends[i] = end_of_ray(leaving[i])) ? 1 : 0;
      for (const std::uint16_t k : lone.more_exits[at.lobe]) {
        const bool sky = sees_sky(k);
        more_sky += sky ? 1 : 0;
        // A kind that only these rays saw takes the place of one link.
        const bool is_new = sky ? skies == 0 : own == 0 && skies == count;
        if (!is_new || count == 0) continue;
        const std::uint32_t end = end_of_ray(k);
        if (is_sky(end) != sky) {  // by rounding: of the kind that is there
          more_sky = sky ? more_sky - 1 : more_sky + 1;
          continue;
        }
        ends[0] = end;
        if (sky)
          ++skies, --more_sky;
        else
          --skies, ++more_sky;
      }
      store_ends(scene_.receivers, ends, at.lobe, more_sky, out);
    });
  }

  // The links within such a tree that neighbours cut, for one instance.
  void trace_cut_links(const LoneTree& tree, const RayScene& alone, const LoneRays& lone,
                       std::uint32_t instance) {
    const TreeNeighbours neighbours(scene_.forest, instance);
    if (!neighbours.any()) return;
    const TreeLinks& t = tree_links(instance);
    const double scale = scene_.forest.instances[instance].scale;
    std::vector<CutLink>& cut = table_.beyond[instance].cut;
    std::mutex adding;
    for_each_lobe(tree, instance, [&](const LobePlace& at) {
      const float* own_m = lone.own_m.data() + (row_of(t, at, links_) - t.rows.data());
      for (int k = 0; k < at.links(); ++k) {
        if (own_m[k] == 0.0f) continue;
        const LinkRay ray = at.ray(k), world = in_world(ray, scene_.forest, instance);
        const double length_m = scale * static_cast<double>(own_m[k]);
        if (!neighbours.may_cut(world.origin_m, world.origin_m + length_m * world.direction)) continue;
        const RayHit other = beyond(instance, world, length_m);
        if (!is_on_tree(other) || other.distance_m >= length_m) continue;
        const RayHit own = alone.closest_hit(ray.origin_m, ray.direction, 0.0, ray.from);
        const std::scoped_lock lock(adding);
        cut.push_back({static_cast<std::uint32_t>(at.lobe), face_of(instance, own_face(tree, own)),
                       scene_.receivers.met_by(other)});
      }
    });
    std::sort(cut.begin(), cut.end());
    cut.shrink_to_fit();
  }

  void trace_ground() {
    const Receivers& r = scene_.receivers;
    InstanceEnds& out = table_.ground;
    make_room(out, r.ground().count(), r.ground().count() * links_);
    for_each_chunk(r.ground().count(), 16, control_, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t cell = begin; cell < end; ++cell) {
        control_.check();
        const SurfaceSampler surface(r, r.two_faced_count() + cell);
        const std::vector<LinkRay> rays =
            rays_of_face(surface, true, table_.links_per_face, cell, mix_seed(seed_, kGroundSeed));
        const std::span<std::uint32_t> row(out.ends.data() + cell * links_, links_);
        for (std::size_t k = 0; k < links_; ++k) {
          const LinkRay& ray = rays[k];
          row[k] =
              end_of(r, scene_.rays.closest_hit(ray.origin_m, ray.direction, 0.0, ray.from), ray.direction);
        }
        store_ends(r, row, cell, 0, out);
      }
    });
  }

 private:
  static constexpr std::uint64_t kGroundSeed = ~std::uint64_t{0};
  static constexpr double kEndless = std::numeric_limits<double>::infinity();

  using LobeVisit = std::function<void(const LobePlace&)>;
  void for_each_lobe(const LoneTree& tree, std::uint32_t instance, const LobeVisit& visit) const {
    for_each_surface(tree, table_.links_per_face, tree_seed(instance), control_,
                     [&](std::size_t s, const SurfaceRays& rays) { visit_lobes(s, rays, visit); });
  }
  // The first time: fills in the lobes.
  void for_each_new_lobe(const LoneTree& tree, std::uint32_t instance, TreeLinks& t,
                         const LobeVisit& visit) const {
    for_each_surface(tree, table_.links_per_face, tree_seed(instance), control_,
                     [&](std::size_t s, const SurfaceRays& rays) {
                       set_lobes(t, s, rays);
                       visit_lobes(s, rays, visit);
                     });
  }
  static void visit_lobes(std::size_t s, const SurfaceRays& rays, const LobeVisit& visit) {
    for (std::size_t lobe = 0; lobe < kLobes; ++lobe) visit({s, kLobes * s + lobe, rays[lobe]});
  }

  // What a ray from an instance meets past that instance within max_m; copies of it in other periods count.
  RayHit beyond(std::uint32_t instance, const LinkRay& ray, double max_m) const {
    return scene_.rays.closest_hit_past(instance, ray.origin_m, ray.direction, ray.from, max_m);
  }

  Found found_from(const LoneTree& tree, const LinkRay& ray, std::uint32_t instance) const {
    const RayHit hit = scene_.rays.closest_hit(ray.origin_m, ray.direction, 0.0, ray.from);
    if (is_on_tree(hit) && hit.instance == instance) return {true, own_face(tree, hit)};
    return {false, end_of(scene_.receivers, hit, ray.direction)};
  }

  // A face of its tree, among all.
  std::uint32_t face_of(std::uint32_t instance, std::size_t face) const {
    const InstanceFaces& at = table_.instances[instance];
    const std::size_t wood = 2 * std::size_t{table_.trees[at.prototype].foliage};
    return static_cast<std::uint32_t>(face < wood ? at.first_leaf + face : at.first_wood + face - wood);
  }

  TreeLinks& tree_links(std::uint32_t instance) {
    return table_.trees[scene_.forest.instances[instance].prototype.value];
  }
  // Every prototype draws its own numbers, wherever it stands.
  std::uint64_t tree_seed(std::uint32_t instance) const {
    return mix_seed(seed_, scene_.forest.instances[instance].prototype.value);
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
  return tree.first_exit.empty() ? 0 : 4 * tree.first_exit.back();
}

}  // namespace

LinkTable trace_links(const LinkScene& scene, int links_per_face, std::uint64_t seed,
                      std::uint64_t memory_limit_bytes, const RunControl& control) {
  LinkTable table = empty_table(scene, links_per_face);
  Tracer tracer(scene, table, seed, control);
  const std::vector<std::vector<std::uint32_t>> stands = instances_of_prototypes(scene.forest);
  std::vector<std::unique_ptr<LoneTree>> trees(stands.size());
  const double steps = static_cast<double>(stands.size() + scene.forest.instances.size());
  std::vector<LoneRays> lone(stands.size());
  std::vector<std::unique_ptr<RayScene>> alone(stands.size());  // prototypes that stand more than once
  double done = 0.0;
  const auto step = [&] { control.report("tracing links", ++done / steps); };
  std::uint64_t bytes = fewest_bytes(scene.receivers, links_per_face);
  for (std::size_t p = 0; p < stands.size(); ++p, step()) {
    if (stands[p].empty()) continue;
    trees[p] = std::make_unique<LoneTree>(scene.forest, PrototypeId{static_cast<std::uint32_t>(p)});
    if (stands[p].size() == 1) {
      tracer.trace_only_instance(*trees[p], stands[p][0]);
    } else {
      alone[p] = std::make_unique<RayScene>(trees[p]->forest(), RayScene::Options{.ground = false}, control);
      lone[p] = tracer.trace_alone(*trees[p], *alone[p], stands[p][0]);
    }
    bytes += stands[p].size() * exit_bytes(table.trees[p]);
    check_memory(bytes, links_per_face, memory_limit_bytes);
  }
  for (std::size_t p = 0; p < stands.size(); ++p)
    for (const std::uint32_t instance : stands[p]) {
      if (stands[p].size() > 1) {
        tracer.trace_exits(*trees[p], lone[p], instance);
        tracer.trace_cut_links(*trees[p], *alone[p], lone[p], instance);
        bytes += table.beyond[instance].cut.size() * sizeof(CutLink);
        check_memory(bytes, links_per_face, memory_limit_bytes);
      }
      step();
    }
  tracer.trace_ground();
  return table;
}

}  // namespace sunfleck::links
