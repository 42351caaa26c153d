#include "lighting/shade/prune.h"

#include <algorithm>
#include <cmath>

#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

constexpr double kLargestLeaf_px = 0.31;  // of an enlarged leaf

// In [0, 1): kept at every share above it.
double priority(std::uint64_t seed, std::size_t leaf) {
  return RandomStream(seed, leaf, RandomPurpose::kLeafPruning).uniform();
}

// Areas of one material, and its leaf that goes last.
struct MaterialArea {
  double all_m2 = 0, kept_m2 = 0;
  std::size_t last = 0;
  double lowest = 2;
};

FoliageElement enlarged(FoliageElement e, double scale) {
  e.half_u_m *= static_cast<float>(scale);
  e.half_v_m *= static_cast<float>(scale);
  e.area_m2 = static_cast<float>(static_cast<double>(e.area_m2) * scale * scale);
  return e;
}

}  // namespace

PrunedFoliage prune_leaves(std::span<const FoliageElement> foliage, double keep, std::uint64_t seed) {
  if (!(keep > 0 && keep <= 1)) throw_invalid("keep", std::to_string(keep), "a share in (0, 1]");
  std::vector<MaterialArea> materials;
  std::vector<std::uint8_t> stays(foliage.size());
  for (std::size_t i = 0; i < foliage.size(); ++i) {
    const FoliageElement& e = foliage[i];
    if (e.material >= materials.size()) materials.resize(e.material + 1u);
    MaterialArea& m = materials[e.material];
    const double own = priority(seed, i);
    m.all_m2 += static_cast<double>(e.area_m2);
    if (own < m.lowest) m.lowest = own, m.last = i;
    stays[i] = keep >= 1 || own < keep;
  }
  for (const MaterialArea& m : materials)
    if (m.lowest < 2) stays[m.last] = 1;
  for (std::size_t i = 0; i < foliage.size(); ++i)
    if (stays[i]) materials[foliage[i].material].kept_m2 += static_cast<double>(foliage[i].area_m2);
  PrunedFoliage pruned;
  for (std::size_t i = 0; i < foliage.size(); ++i) {
    if (!stays[i]) continue;
    const MaterialArea& m = materials[foliage[i].material];
    const double scale = m.kept_m2 > 0 ? std::sqrt(m.all_m2 / m.kept_m2) : 1;
    pruned.foliage.push_back(keep < 1 ? enlarged(foliage[i], scale) : foliage[i]);
    pruned.original.push_back(static_cast<std::uint32_t>(i));
  }
  return pruned;
}

Prototype prune_prototype(const Prototype& prototype, double keep, std::uint64_t seed) {
  Prototype pruned = prototype;
  pruned.foliage = prune_leaves(prototype.foliage, keep, seed).foliage;
  return pruned;
}

double prune_share(double leaf_side_m, double footprint_m) {
  SUNFLECK_EXPECTS(leaf_side_m > 0 && footprint_m > 0);
  const double share = leaf_side_m / footprint_m / kLargestLeaf_px;
  return std::clamp(share * share, kPruneLevels.back(), 1.0);
}

int choose_prune_level(double leaf_side_m, double footprint_m, double uniform) {
  // A larger leaf stands in for the choice: level k is taken where share allows it for a leaf up to 1.4 times
  // as large, so the threshold itself is never crossed.
  const double share = prune_share(leaf_side_m * (1 + 0.4 * uniform), footprint_m);
  int level = 0;
  while (level + 1 < static_cast<int>(kPruneLevels.size()) &&
         kPruneLevels[static_cast<std::size_t>(level) + 1] >= share * (1 - 1e-12))
    ++level;
  return level;
}

}  // namespace sunfleck
