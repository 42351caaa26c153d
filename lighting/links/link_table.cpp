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

template <class T>
std::uint64_t bytes_of(const std::vector<T>& v) {
  return v.capacity() * sizeof(T);
}

}  // namespace

FaceLinks LinkTable::of_tree_face(std::size_t instance, std::size_t face) const {
  const TreeLinks& tree = trees[instances[instance].prototype];
  const InstanceEnds& out = beyond[instance];
  const auto links = static_cast<std::size_t>(links_per_face);
  const std::span<const std::uint32_t> row(tree.rows.data() + face * links, links);
  const std::size_t leaves = tree.leaf_hits[face], own = tree.own_hits[face];
  const auto ends =
      tree.stands_once ? row.subspan(own)
                       : std::span<const std::uint32_t>(out.ends.data() + tree.first_exit[face], links - own);
  const std::size_t met = out.faces_met[face];
  return {row.first(leaves), row.subspan(leaves, own - leaves), ends.first(met), ends.subspan(met)};
}

FaceLinks LinkTable::of_ground(std::size_t cell) const {
  const auto links = static_cast<std::size_t>(links_per_face);
  const std::span<const std::uint32_t> row(ground.ends.data() + cell * links, links);
  const std::size_t met = ground.faces_met[cell];
  return {{}, {}, row.first(met), row.subspan(met)};
}

std::uint64_t LinkTable::bytes() const {
  std::uint64_t sum = bytes_of(instances) + bytes_of(ground.ends) + bytes_of(ground.faces_met);
  for (const TreeLinks& t : trees)
    sum += bytes_of(t.rows) + bytes_of(t.leaf_hits) + bytes_of(t.own_hits) + bytes_of(t.first_exit) +
           bytes_of(t.is_shoot);
  for (const InstanceEnds& i : beyond) sum += bytes_of(i.ends) + bytes_of(i.faces_met);
  return sum;
}

double sum_met(const FaceLinks& links, const float* leaves, const float* wood, const float* all) {
  return sum_at(links.own_leaves, leaves) + sum_at(links.own_wood, wood) + sum_at(links.met, all);
}

}  // namespace sunfleck::links
