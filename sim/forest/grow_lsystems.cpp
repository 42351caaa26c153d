// TreeSource::kLsystem. A tree with any measure but its diameter gets a prototype of its own size. The others
// of a species are sorted by diameter and cut into classes of equal numbers; each class has `variants`
// prototypes of its mean diameter. Such a tree takes a variant by hash and is scaled from the prototype's
// height to its own, by 15 % at most: beyond that a scaled tree has leaves and diameters of another species,
// and more size classes are the better way. All are turned by hash. Prototypes: shared ones by kind, then
// those of single trees in the order of the stand.

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"
#include "sim/forest/stand.h"
#include "sim/forest/tree_size.h"
#include "sim/plant/grow_foliage.h"

namespace sunfleck {

namespace {

constexpr double kMostScaling = 0.15;
constexpr double kMostOwnElements = 2e8;  // of prototypes for single trees: 8.8 GB

// Which prototype: ordered by species name, so that the order of the inventory does not matter.
struct Kind {
  std::string latin;
  int size_class = 0, variant = 0;
  TreeForm form = TreeForm::kStandGrown;
  auto operator<=>(const Kind&) const = default;
};

struct Plan {
  std::vector<std::size_t> measured;     // trees with prototypes of their own
  std::vector<Kind> kind_of_tree;        // of the others
  std::map<Kind, double> mean_dbh_cm;    // of a size class (its variant 0)
  std::map<Kind, const Species*> kinds;  // that are used
};

std::uint64_t hash_of(const std::string& text) {
  std::uint64_t hash = text.size();
  for (const char c : text) hash = mix_seed(hash, static_cast<unsigned char>(c));
  return hash;
}

std::uint64_t seed_of_tree(const ForestSpec& spec, const InventoryTree& tree) {
  return mix_seed(mix_seed(spec.seed, hash_of("tree")), tree.id.value);
}

// Trees (indexes) of each species and form known by diameter only, thin ones first.
using Groups = std::map<std::pair<std::string, TreeForm>, std::vector<std::size_t>>;
Groups trees_by_species(const std::vector<StandTree>& stand) {
  Groups groups;
  for (std::size_t i = 0; i < stand.size(); ++i)
    if (!is_measured(stand[i].tree)) groups[{stand[i].species->latin, stand[i].tree.form}].push_back(i);
  for (auto& [of, trees] : groups) {
    std::sort(trees.begin(), trees.end(), [&](std::size_t a, std::size_t b) {
      const InventoryTree &first = stand[a].tree, &second = stand[b].tree;
      return std::tie(first.dbh_cm, first.id) < std::tie(second.dbh_cm, second.id);
    });
  }
  return groups;
}

void plan_class(const ForestSpec& spec, const std::vector<StandTree>& stand, std::vector<std::size_t> members,
                const Species& species, int size_class, Plan& plan) {
  const TreeForm form = stand[members.front()].tree.form;
  double sum_cm = 0;
  for (const std::size_t i : members) {
    const std::uint64_t hash = seed_of_tree(spec, stand[i].tree);
    const int variant = static_cast<int>(hash % static_cast<std::uint64_t>(spec.variants));
    plan.kind_of_tree[i] = {species.latin, size_class, variant, form};
    plan.kinds[plan.kind_of_tree[i]] = &species;
    sum_cm += stand[i].tree.dbh_cm;
  }
  plan.mean_dbh_cm[{species.latin, size_class, 0, form}] = sum_cm / static_cast<double>(members.size());
}

Plan plan_prototypes(const ForestSpec& spec, const std::vector<StandTree>& stand, int size_classes) {
  Plan plan;
  plan.kind_of_tree.resize(stand.size());
  for (std::size_t i = 0; i < stand.size(); ++i)
    if (is_measured(stand[i].tree)) plan.measured.push_back(i);
  for (const auto& [of, trees] : trees_by_species(stand)) {
    const std::size_t classes = std::min(static_cast<std::size_t>(size_classes), trees.size());
    const auto cut = [&, n = trees.size()](std::size_t c) {
      return trees.begin() + static_cast<std::ptrdiff_t>(c * n / classes);
    };
    for (std::size_t c = 0; c < classes; ++c) {
      plan_class(spec, stand, {cut(c), cut(c + 1)}, *stand[trees[0]].species, static_cast<int>(c), plan);
    }
  }
  return plan;
}

// With the leaf area that was asked for.
TreeSize with_leaf_area(const ForestSpec& spec, const Species& species, TreeSize size) {
  if (spec.leaf_area == LeafAreaSource::kAllometry)
    size.leaf_area_m2 = species.leaf_area_m2(100 * size.dbh_m, size.height_m);
  size.leaf_area_m2 *= spec.leaf_area_factor;
  return size;
}

double mean_dbh_cm(const Plan& plan, Kind kind) {
  kind.variant = 0;
  return plan.mean_dbh_cm.at(kind);
}

Prototype grow_kind(const ForestSpec& spec, const Plan& plan, const Kind& kind, const RunControl& control) {
  const Species& species = *plan.kinds.at(kind);
  const double dbh_cm = mean_dbh_cm(plan, kind);
  const bool open = kind.form == TreeForm::kOpenGrown;
  const auto number = static_cast<std::uint64_t>(kind.size_class * spec.variants + kind.variant);
  const std::uint64_t species_seed = mix_seed(spec.seed, hash_of(kind.latin + (open ? " open" : "")));
  const std::uint64_t seed = mix_seed(species_seed, number);
  Prototype prototype =
      grow_prototype(species, with_leaf_area(spec, species, expected_size(species, dbh_cm, kind.form)), seed,
                     spec.detail, control);
  prototype.name = kind.latin + (open ? " open-grown" : "") + " class " +
                   std::to_string(kind.size_class + 1) + " variant " + std::to_string(kind.variant + 1);
  return prototype;
}

Prototype grow_measured(const ForestSpec& spec, const StandTree& entry, const RunControl& control) {
  const TreeSize size = with_leaf_area(spec, *entry.species, tree_size(entry.tree, *entry.species));
  try {
    Prototype prototype =
        grow_prototype(*entry.species, size, seed_of_tree(spec, entry.tree), spec.detail, control);
    prototype.name = entry.species->latin + " " + std::to_string(entry.tree.id.value);
    return prototype;
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::kCancelled) throw;
    throw Error(error.kind(), tree_label(entry.tree) + ": " + error.where(), error.problem(), error.remedy());
  }
}

void check_options(const ForestSpec& spec, const std::vector<StandTree>& stand) {
  if (spec.size_classes < 1 || spec.variants < 1 || spec.size_classes > 1000 || spec.variants > 1000) {
    throw_invalid("forest.size_classes, forest.variants", "are not both from 1 to 1000", "1 to 1000 each");
  }
  if (!(spec.detail > 0 && spec.detail <= 1)) {
    throw_invalid("forest.detail", "is " + std::to_string(spec.detail), "above 0, at most 1");
  }
  for (const StandTree& entry : stand) {
    if (!entry.species->grammar.empty()) continue;
    throw_invalid(tree_label(entry.tree), entry.species->latin + " has no grammar",
                  "use trees = \"crown\" for this stand");
  }
}

// Says at once which measured trees cannot be, and how much memory the others would take.
void check_measured(const ForestSpec& spec, const std::vector<StandTree>& stand, const Plan& plan) {
  double elements = 0;
  for (const std::size_t i : plan.measured) {
    const double leaf_area_m2 =
        with_leaf_area(spec, *stand[i].species, tree_size(stand[i].tree, *stand[i].species)).leaf_area_m2;
    elements += spec.detail * leaf_area_m2 / template_area_m2(stand[i].species->foliage);
  }
  if (elements <= kMostOwnElements) return;
  throw Error(ErrorKind::kLimitExceeded, "forest.detail",
              "the measured trees would have " + std::to_string(static_cast<std::uint64_t>(elements)) +
                  " foliage elements in all",
              "at most 200000000: a smaller detail, or trees = \"crown\"");
}

void grow_all(const ForestSpec& spec, const std::vector<StandTree>& stand, const Plan& plan,
              const RunControl& control, Forest& forest) {
  std::vector<Kind> kinds;
  for (const auto& [kind, species] : plan.kinds) kinds.push_back(kind);
  forest.prototypes.resize(kinds.size() + plan.measured.size());
  const RunControl stop_only{control.stop, {}};  // progress is counted in prototypes
  const auto grown = [&](std::size_t i) {
    if (i < kinds.size()) return grow_kind(spec, plan, kinds[i], stop_only);
    return grow_measured(spec, stand[plan.measured[i - kinds.size()]], stop_only);
  };
  for_each_chunk(forest.prototypes.size(), 1, control, kGrowingStage,
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t i = begin; i < end; ++i) forest.prototypes[i] = grown(i);
                 });
}

std::vector<PrototypeId> prototype_of_tree(const Plan& plan) {
  std::vector<PrototypeId> result(plan.kind_of_tree.size());
  std::map<Kind, std::uint32_t> index_of_kind;
  for (const auto& [kind, species] : plan.kinds) {
    index_of_kind.emplace(kind, static_cast<std::uint32_t>(index_of_kind.size()));
  }
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto found = index_of_kind.find(plan.kind_of_tree[i]);
    if (found != index_of_kind.end()) result[i] = {found->second};
  }
  auto next = static_cast<std::uint32_t>(index_of_kind.size());
  for (const std::size_t i : plan.measured) result[i] = {next++};
  return result;
}

// Number of trees that wanted more scaling than they got.
std::size_t place_instances(const ForestSpec& spec, const std::vector<StandTree>& stand, const Plan& plan,
                            Forest& forest) {
  const std::vector<PrototypeId> prototypes = prototype_of_tree(plan);
  std::vector<double> height_m;
  for (const Prototype& prototype : forest.prototypes) height_m.push_back(measure(prototype).height_m);
  std::size_t held = 0;
  for (std::size_t i = 0; i < stand.size(); ++i) {
    const InventoryTree& tree = stand[i].tree;
    const double wanted =
        is_measured(tree) ? 1.0 : tree_height_m(tree, *stand[i].species) / height_m[prototypes[i].value];
    const double scale = std::clamp(wanted, 1.0 - kMostScaling, 1.0 + kMostScaling);
    held += wanted != scale ? 1 : 0;
    RandomStream random(seed_of_tree(spec, tree), 0, RandomPurpose::kPlanting);
    forest.instances.push_back({stem_foot_m(forest.terrain, tree), prototypes[i],
                                static_cast<float>(random.uniform(0.0, 2.0 * kPi)), static_cast<float>(scale),
                                tree.id});
  }
  return held;
}

// True if all trees are within what scaling may do of the expected height of their class's mean diameter,
// with a margin for prototypes that are not quite as tall as expected.
bool classes_suffice(const ForestSpec& spec, const std::vector<StandTree>& stand, int size_classes) {
  const Plan plan = plan_prototypes(spec, stand, size_classes);
  for (std::size_t i = 0; i < stand.size(); ++i) {
    if (is_measured(stand[i].tree)) continue;
    const Species& species = *stand[i].species;
    const Kind& kind = plan.kind_of_tree[i];
    const double usual_m = expected_size(species, mean_dbh_cm(plan, kind), kind.form).height_m;
    if (std::abs(tree_height_m(stand[i].tree, species) / usual_m - 1) > kMostScaling - 0.02) return false;
  }
  return true;
}

std::string note_of_held(const ForestSpec& spec, const std::vector<StandTree>& stand, std::size_t held) {
  int enough = spec.size_classes;
  bool suffices = false;
  while (!suffices && enough < 1000) {
    enough = std::min(2 * enough, 1000);
    suffices = classes_suffice(spec, stand, enough);
  }
  return std::to_string(held) + " of " + std::to_string(stand.size()) +
         " trees are over 15 % taller or shorter than the shared trees of their size class and were scaled "
         "by "
         "15 % only; " +
         (suffices ? "forest.size_classes = " + std::to_string(enough) + " meets all heights"
                   : "an inventory with h_m meets their heights");
}

}  // namespace

void grow_lsystems(const ForestSpec& spec, const std::vector<StandTree>& stand, const RunControl& control,
                   Forest& forest, std::vector<std::string>& notes) {
  check_options(spec, stand);
  const Plan plan = plan_prototypes(spec, stand, spec.size_classes);
  check_measured(spec, stand, plan);
  grow_all(spec, stand, plan, control, forest);
  const std::size_t held = place_instances(spec, stand, plan, forest);
  if (held == 0) return;
  notes.push_back(note_of_held(spec, stand, held));
}

}  // namespace sunfleck
