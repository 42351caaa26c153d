#include "lighting/render/shown_trees.h"

#include <cmath>
#include <map>
#include <tuple>

#include "lighting/shade/prune.h"
#include "lighting/shade/thin_wood.h"
#include "sim/base/contract.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

constexpr double kTwigPerLeaf = 0.25;  // thinnest twig over an enlarged leaf's side
constexpr std::uint64_t kPruneSeed = 0x7072756E65;

double kept_share(Detail detail) {
  switch (detail) {
    case Detail::kPruned4:
      return kPruneLevels[1];
    case Detail::kPruned16:
      return kPruneLevels[2];
    case Detail::kPruned64:
      return kPruneLevels[3];
    default:
      SUNFLECK_EXPECTS(detail == Detail::kExplicit);
      return 1.0;
  }
}

struct ShownTree {
  Prototype prototype;
  std::vector<std::uint32_t> originals;
};

// Another level of detail (Detail::kBough) is one more way to fill a prototype here.
ShownTree shown_tree(const Prototype& prototype, Detail detail, std::uint64_t seed) {
  const double keep = kept_share(detail);
  if (keep == 1.0) return {prototype, {}};
  ShownTree shown;
  shown.prototype = {prototype.name,      prototype.materials,   {}, {},
                     prototype.wood_mesh, prototype.stated_dbh_m};
  const double twig_m = kTwigPerLeaf * leaf_side_m(prototype.foliage) / std::sqrt(keep);
  PrunedFoliage pruned = prune_leaves(prototype.foliage, keep, seed);
  shown.prototype.foliage = std::move(pruned.foliage);
  shown.prototype.wood = thin_wood(prototype.wood, twig_m, seed);
  shown.originals = std::move(pruned.original);
  return shown;
}

class Company {
 public:
  explicit Company(const Forest& forest) : forest_(forest) {}

  PrototypeId id_of(PrototypeId prototype, Detail detail, int cast) {
    const int pruning = detail == Detail::kExplicit ? 0 : cast;
    const auto [at, is_new] = known_.try_emplace({prototype.value, detail, pruning}, next_id());
    if (is_new) add(prototype, detail, mix_seed(kPruneSeed, static_cast<std::uint64_t>(pruning)));
    return at->second;
  }

  ShownTrees shown;

 private:
  PrototypeId next_id() const { return PrototypeId{static_cast<std::uint32_t>(shown.detail.size())}; }
  void add(PrototypeId prototype, Detail detail, std::uint64_t seed) {
    ShownTree tree = shown_tree(forest_.prototypes[prototype.value], detail, seed);
    shown.forest.prototypes.push_back(std::move(tree.prototype));
    shown.originals.push_back(std::move(tree.originals));
    shown.original_prototype.push_back(prototype);
    shown.detail.push_back(detail);
  }

  const Forest& forest_;
  std::map<std::tuple<std::uint32_t, Detail, int>, PrototypeId> known_;
};

}  // namespace

ShownTrees same_trees(const Forest& forest) {
  ShownTrees shown;
  shown.forest = forest;
  shown.originals.resize(forest.prototypes.size());
  shown.detail.assign(forest.prototypes.size(), Detail::kExplicit);
  for (std::uint32_t p = 0; p < forest.prototypes.size(); ++p)
    shown.original_prototype.push_back(PrototypeId{p});
  return shown;
}

ShownTrees show_trees(const Forest& forest, const TreeDetails& details, const RunControl& control) {
  SUNFLECK_EXPECTS(!details.casts.empty());
  Company company(forest);
  ShownTrees& shown = company.shown;
  shown.forest.name = forest.name;
  shown.forest.materials = forest.materials;
  shown.forest.instances = forest.instances;
  shown.forest.terrain = forest.terrain;
  shown.forest.period = forest.period;
  for (std::size_t c = 0; c < details.casts.size(); ++c) {
    std::vector<PrototypeId>& cast = shown.casts.emplace_back();
    cast.reserve(forest.instances.size());
    for (std::size_t i = 0; i < forest.instances.size(); ++i) {
      if (i % 1024 == 0) control.check();
      cast.push_back(company.id_of(forest.instances[i].prototype, details.casts[c][i], static_cast<int>(c)));
    }
  }
  for (std::size_t i = 0; i < forest.instances.size(); ++i)
    shown.forest.instances[i].prototype = shown.casts[0][i];
  return std::move(shown);
}

}  // namespace sunfleck
