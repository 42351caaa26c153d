// See crown_potential.h.
#include "lighting/canopy/crown_potential.h"

#include <algorithm>

#include "lighting/canopy/crown_rays.h"
#include "sim/base/contract.h"
#include "sim/base/parallel.h"

namespace sunfleck {

namespace {

// Instances of every prototype.
std::vector<std::vector<std::size_t>> trees_by_prototype(const Forest& forest) {
  std::vector<std::vector<std::size_t>> trees(forest.prototypes.size());
  for (std::size_t i = 0; i < forest.instances.size(); ++i)
    trees[forest.instances[i].prototype.value].push_back(i);
  return trees;
}

}  // namespace

ResponseTable crown_potential(const StandScene& scene, const LightSource& source,
                              const std::vector<int>& rays, std::uint64_t seed, const RunControl& control) {
  SUNFLECK_EXPECTS(rays.size() == source.size());
  const Forest& forest = scene.forest();
  ResponseTable table(ResponseTable::Kind::kAmount, source.size(), forest.instances.size());
  std::vector<float> quantum_m2(table.value.size());
  const auto trees = trees_by_prototype(forest);
  for_each_chunk(trees.size(), 1, control, "trees alone", [&](std::size_t p, std::size_t) {
    const auto asked = [&](std::size_t t) { return scene.is_asked(t); };
    if (std::none_of(trees[p].begin(), trees[p].end(), asked)) return;
    const CrownAlone crown(forest, p, control);
    for (const std::size_t t : trees[p]) {
      if (!scene.is_asked(t)) continue;
      const Instance& tree = forest.instances[t];
      const double scale2 = static_cast<double>(tree.scale) * tree.scale;
      RandomStream random(seed, t, RandomPurpose::kStandRays);
      control.check();
      for (std::size_t d = 0; d < source.size(); ++d) {
        if (rays[d] < 1 || !(scene.ground().facing(source.to_source[d]) > 0.0)) continue;
        const Vec3 to_source = tree_direction_from_world(tree, source.to_source[d]);
        const auto got = crown.intercept(to_source, source.half_angle(d), rays[d], random);
        table.row(d)[t] = static_cast<float>(scale2 * got.m2);
        quantum_m2[d * table.targets + t] = static_cast<float>(scale2 * got.quantum_m2);
      }
    }
  });
  double asked = 0.0;
  for (std::size_t t = 0; t < table.targets; ++t) asked += scene.is_asked(t) ? 1.0 : 0.0;
  for (std::size_t d = 0; d < source.size(); ++d)
    for (std::size_t t = 0; t < table.targets; ++t)
      table.quantum[d] += quantum_m2[d * table.targets + t] / asked;
  return table;
}

}  // namespace sunfleck
