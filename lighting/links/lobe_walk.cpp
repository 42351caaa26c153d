#include "lighting/links/lobe_walk.h"

#include "lighting/trace/visiting_order.h"
#include "sim/base/parallel.h"

namespace sunfleck::links {

void for_each_lobe(const LoneTree& tree, int links_per_face, std::uint64_t seed, const RunControl& control,
                   const LobeVisit& visit) {
  const std::vector<std::uint32_t> order = trace::visiting_order(tree.receivers());
  for_each_chunk(order.size(), 8, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      control.check();
      const std::size_t s = order[i];
      const trace::SurfaceSampler sampler(tree.receivers(), s);
      const Lobes lobes = lobes_of(tree, s, links_per_face);
      for (const Lobe lobe : {kFrontUp, kFrontDown, kBackUp, kBackDown})
        visit({s, kLobes * s + lobe, LobeRays(sampler, s, lobe, part_of(tree, s, lobe), seed),
               lobes[lobe].links, lobes[lobe].cast});
    }
  });
}

TreeLinks empty_links(const LoneTree& tree, int links_per_face) {
  TreeLinks t;
  t.foliage = static_cast<std::uint32_t>(tree.receivers().foliage_count());
  t.wood = static_cast<std::uint32_t>(tree.receivers().wood_count());
  t.rows.resize(t.surfaces() * 2 * static_cast<std::size_t>(links_per_face));
  t.leaf_hits.resize(t.surfaces() * kLobes);
  t.own_hits.resize(t.surfaces() * kLobes);
  t.links.reserve(t.leaf_hits.size());
  t.cast.reserve(t.leaf_hits.size());
  t.weight.reserve(t.leaf_hits.size());
  t.is_shoot.reserve(t.foliage);
  for (std::size_t s = 0; s < t.surfaces(); ++s)
    for (const LobeShare& lobe : lobes_of(tree, s, links_per_face)) {
      t.links.push_back(static_cast<std::uint16_t>(lobe.links));
      t.cast.push_back(static_cast<std::uint16_t>(lobe.cast));
      t.weight.push_back(static_cast<float>(lobe.weight));
    }
  for (const FoliageElement& e : tree.forest().prototypes[0].foliage)
    t.is_shoot.push_back(e.shape == ElementShape::kShoot);
  return t;
}

}  // namespace sunfleck::links
