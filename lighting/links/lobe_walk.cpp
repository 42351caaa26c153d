#include "lighting/links/lobe_walk.h"

#include "lighting/trace/visiting_order.h"
#include "sim/base/parallel.h"

namespace sunfleck::links {

void for_each_surface(const LoneTree& tree, int links_per_face, std::uint64_t seed, const RunControl& control,
                      const SurfaceVisit& visit) {
  const std::vector<std::uint32_t> order = trace::visiting_order(tree.receivers());
  for_each_chunk(order.size(), 8, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      control.check();
      visit(order[i], rays_of_surface(tree, order[i], links_per_face, seed));
    }
  });
}

TreeLinks empty_links(const LoneTree& tree, int links_per_face) {
  TreeLinks t;
  t.foliage = static_cast<std::uint32_t>(tree.receivers().foliage_count());
  t.wood = static_cast<std::uint32_t>(tree.receivers().wood_count());
  t.rows.resize(t.surfaces() * 2 * static_cast<std::size_t>(links_per_face));
  for (auto* counts : {&t.links, &t.cast, &t.leaf_hits, &t.own_hits}) counts->resize(t.surfaces() * kLobes);
  t.weight.resize(t.surfaces() * kLobes);
  t.is_shoot.reserve(t.foliage);
  for (const FoliageElement& e : tree.forest().prototypes[0].foliage)
    t.is_shoot.push_back(e.shape == ElementShape::kShoot);
  return t;
}

void set_lobes(TreeLinks& tree, std::size_t surface, const SurfaceRays& rays) {
  for (std::size_t l = 0; l < kLobes; ++l) {
    tree.links[kLobes * surface + l] = static_cast<std::uint16_t>(rays[l].links);
    tree.cast[kLobes * surface + l] = static_cast<std::uint16_t>(rays[l].rays.size());
    tree.weight[kLobes * surface + l] = static_cast<float>(rays[l].weight);
  }
}

}  // namespace sunfleck::links
