#include "lighting/links/link_table.h"

namespace sunfleck::links {
namespace {

// Eight chains of additions.
double sum_at(std::span<const std::uint32_t> where, const float* values) {
  float chains[8] = {};
  std::size_t k = 0;
  for (; k + 8 <= where.size(); k += 8)
    for (std::size_t i = 0; i < 8; ++i) chains[i] += values[where[k + i]];
  float rest = 0.0f;
  for (; k < where.size(); ++k) rest += values[where[k]];
  double sum = rest;
  for (const float chain : chains) sum += chain;
  return sum;
}

using Row = std::span<const std::uint32_t>;

// The ends of a lobe by kind, and what each weighs. Wherever a kind was seen at all, one of it is kept.
LobeLinks sorted(const Row& ends, const InstanceEnds& out, std::size_t lobe, std::size_t own_hits,
                 double weight, std::size_t cast) {
  const std::size_t met = out.faces_met[lobe], not_sky = out.not_sky[lobe];
  const auto sky_rays = static_cast<double>(out.sky_rays[lobe]), all_rays = static_cast<double>(cast);
  LobeLinks l;
  l.met = ends.first(met);
  l.dark_ground = ends.subspan(met, not_sky - met);
  l.sky = ends.subspan(not_sky);
  const std::size_t hits = own_hits + not_sky;
  if (hits > 0) l.per_hit = weight * (all_rays - sky_rays) / all_rays / static_cast<double>(hits);
  if (!l.sky.empty()) l.per_sky = weight * sky_rays / all_rays / static_cast<double>(l.sky.size());
  return l;
}

template <class T>
std::uint64_t bytes_of(const std::vector<T>& v) {
  return v.capacity() * sizeof(T);
}

std::uint64_t bytes_of(const InstanceEnds& e) {
  return bytes_of(e.ends) + bytes_of(e.faces_met) + bytes_of(e.not_sky) + bytes_of(e.sky_rays) +
         bytes_of(e.cut);
}

}  // namespace

std::size_t lobe_begin(const TreeLinks& tree, std::size_t surface, Lobe lobe) {
  std::size_t begin = 0;
  for (std::size_t l = 0; l < lobe; ++l) begin += tree.links[kLobes * surface + l];
  return begin;
}

LobeLinks LinkTable::of_lobe(std::size_t instance, std::size_t surface, Lobe lobe) const {
  const TreeLinks& tree = trees[instances[instance].prototype];
  const InstanceEnds& out = beyond[instance];
  const std::size_t l = kLobes * surface + lobe;
  const std::size_t row = 2 * static_cast<std::size_t>(links_per_face) * surface;
  const Row links(tree.rows.data() + row + lobe_begin(tree, surface, lobe), tree.links[l]);
  const std::size_t leaves = tree.leaf_hits[l], own = tree.own_hits[l];
  const Row ends = tree.first_exit.empty() ? links.subspan(own)
                                           : Row(out.ends.data() + tree.first_exit[l], links.size() - own);
  LobeLinks found = sorted(ends, out, l, own, tree.weight[l], tree.cast[l]);
  found.own_leaves = links.first(leaves);
  found.own_wood = links.subspan(leaves, own - leaves);
  return found;
}

LobeLinks LinkTable::of_ground(std::size_t cell) const {
  const auto links = static_cast<std::size_t>(links_per_face);
  return sorted(Row(ground.ends.data() + cell * links, links), ground, cell, 0, 1.0, links);
}

std::uint64_t LinkTable::bytes() const {
  std::uint64_t sum = bytes_of(instances) + bytes_of(ground);
  for (const TreeLinks& t : trees)
    sum += bytes_of(t.rows) + bytes_of(t.links) + bytes_of(t.cast) + bytes_of(t.leaf_hits) +
           bytes_of(t.own_hits) + bytes_of(t.weight) + bytes_of(t.first_exit) + bytes_of(t.is_shoot);
  for (const InstanceEnds& i : beyond) sum += bytes_of(i);
  return sum;
}

double sum_met(const LobeLinks& links, const float* leaves, const float* wood, const float* all) {
  return sum_at(links.own_leaves, leaves) + sum_at(links.own_wood, wood) + sum_at(links.met, all);
}

}  // namespace sunfleck::links
