// A tree of a species from its grammar: the size goes in as constants, the drawing comes out as foliage and
// wood. The grammar gives the architecture; leaf area, stem diameter and outline are then met exactly, and
// branches that cross others are taken away. Holds for upright trees. Whether a tree stood alone or among
// others the grammar sees from its size: from the length and width of its crown.
#include <algorithm>
#include <numeric>

#include "sim/base/error.h"
#include "sim/lsystem/lsystem.h"
#include "sim/plant/grow_foliage.h"
#include "sim/plant/grow_reshape.h"
#include "sim/plant/grow_wood.h"
#include "sim/plant/make_prototype.h"
#include "sim/plant/wood_contacts.h"

namespace sunfleck {
namespace {

constexpr double kLeastOrgans = 0.98, kUsualOrgans = 1.15, kMostOrgans = 1.5;  // per organ that is needed
constexpr double kLeastDensity = 0.02, kMostDensity = 50;
constexpr int kMostDrawings = 4;

void require_size(const TreeSize& size, double detail, const std::string& where) {
  const bool ordered = size.dbh_m > 0 && size.height_m > size.crown_base_m && size.crown_base_m > 0 &&
                       size.crown_radius_m > 0 && size.leaf_area_m2 > 0;
  if (!ordered ||
      !(size.dbh_m < 10 && size.height_m < 200 && size.crown_radius_m < 100 && size.leaf_area_m2 < 1e5))
    throw_invalid(where + ": size",
                  "no size of a tree: DBH " + std::to_string(size.dbh_m) + " m, height " +
                      std::to_string(size.height_m) + " m, crown base " + std::to_string(size.crown_base_m) +
                      " m, crown radius " + std::to_string(size.crown_radius_m) + " m, leaf area " +
                      std::to_string(size.leaf_area_m2) + " m2",
                  "positive numbers, crown base below height, at most 10 m DBH, 200 m, 100 m, 1e5 m2");
  if (!(detail > 0 && detail <= 1))
    throw_invalid(where + ": detail", std::to_string(detail), "a share of foliage elements in (0, 1]");
}

std::map<std::string, double> grammar_constants(const Species& species, const TreeSize& size) {
  const bool leaf = species.foliage.kind == FoliageKind::kLeaf;
  return {{"HEIGHT", size.height_m},
          {"CROWN_BASE", size.crown_base_m},
          {"CROWN_RADIUS", size.crown_radius_m},
          {"DBH", size.dbh_m},
          {"LEAF_AREA", size.leaf_area_m2},
          {"ELEMENT_LENGTH", leaf ? species.foliage.leaf_length_m : species.foliage.shoot_length_m}};
}

lsystem::Drawing draw(const Species& species, const std::map<std::string, double>& constants,
                      std::uint64_t seed, const RunControl& control) {
  const auto grammar = lsystem::Grammar::load(species.grammar, constants);
  lsystem::DeriveOptions options;
  options.seed = seed;
  auto drawing =
      grammar.interpret(grammar.derive(options, control), lsystem::StartFrame::kTree, options, control);
  if (drawing.organs.empty())
    throw_invalid(species.grammar.string(), "draws no organ for " + species.latin,
                  "an `organs:` line and modules that place them at this size");
  return drawing;
}

// The drawing with about as many organs as the leaf area needs: DENSITY, which grammars use as the number of
// leafy twigs per length of branch, follows the count. Few trees need more than two drawings; one without
// response to DENSITY (its grammar has no use for it) is taken as it is.
lsystem::Drawing draw_to_leaf_area(const Species& species, const TreeSize& size, std::uint64_t seed,
                                   const RunControl& control) {
  auto constants = grammar_constants(species, size);
  const double needed = size.leaf_area_m2 / template_area_m2(species.foliage);
  double density = 1, before = 0;
  for (int round = 0;; ++round) {
    constants["DENSITY"] = density;
    auto drawing = draw(species, constants, seed, control);
    const auto organs = static_cast<double>(drawing.organs.size());
    const bool enough = organs >= kLeastOrgans * needed && organs <= kMostOrgans * needed;
    if (enough || round == kMostDrawings - 1 || organs == before) return drawing;
    before = organs;
    density = std::clamp(density * kUsualOrgans * needed / organs, kLeastDensity, kMostDensity);
  }
}

// The tree with all its organs, fitted to its size.
Prototype whole_tree(const Species& species, const TreeSize& size, const lsystem::Drawing& drawing,
                     std::span<const std::size_t> organs, std::vector<WoodSegment> wood) {
  Prototype tree;
  tree.name = species.latin;
  tree.materials = {species.material.name};
  tree.foliage = foliage_of(drawing.organs, organs, species.foliage, size.leaf_area_m2);
  tree.wood = std::move(wood);
  scale_wood_to_dbh(tree, size.dbh_m);
  reshape_to_size(tree, size);
  scale_wood_to_dbh(tree, size.dbh_m);  // the reshaped stem has another segment at 1.3 m
  return tree;
}

std::vector<std::size_t> all_organs(const lsystem::Drawing& drawing) {
  std::vector<std::size_t> organs(drawing.organs.size());
  std::iota(organs.begin(), organs.end(), std::size_t{0});
  return organs;
}

// Takes the branches away that cross others in the fitted tree, with their organs.
void remove_crossing(lsystem::Drawing& drawing, const Prototype& fitted) {
  std::vector<std::int32_t> parents;
  for (const lsystem::Segment& segment : drawing.segments) parents.push_back(segment.parent);
  const std::vector<bool> away = crossing_branches(fitted.wood, parents, 0);
  std::erase_if(drawing.organs, [&](const lsystem::Organ& organ) {
    return organ.segment >= 0 && away[static_cast<std::size_t>(organ.segment)];
  });
}

std::vector<WoodSegment> carrying_wood(const lsystem::Drawing& drawing, std::span<const std::size_t> organs,
                                       const std::vector<WoodSegment>& wood) {
  const std::vector<bool> carries = carrying_segments(drawing, organs);
  std::vector<WoodSegment> kept;
  for (std::size_t i = 0; i < wood.size(); ++i)
    if (carries[i]) kept.push_back(wood[i]);
  return kept;
}

}  // namespace

Prototype grow_prototype(const Species& species, const TreeSize& size, std::uint64_t seed, double detail,
                         const RunControl& control) {
  require_size(size, detail, species.latin);
  if (species.grammar.empty())
    throw_invalid(species.latin + ": grammar", "the species has no grammar to grow",
                  "a `grammar` in its file, or a crown filled with leaves");
  lsystem::Drawing drawing = draw_to_leaf_area(species, size, seed, control);
  const std::vector<WoodSegment> wood =
      piped_wood(drawing, kPipeExponent, living_share(size.dbh_m, size.leaf_area_m2));
  remove_crossing(drawing, whole_tree(species, size, drawing, all_organs(drawing), wood));
  const auto kept = choose_organs(drawing.organs.size(), species.foliage, size.leaf_area_m2, detail, seed);
  Prototype tree = whole_tree(species, size, drawing, kept, carrying_wood(drawing, kept, wood));
  validate(tree, species.grammar.string());
  return tree;
}

}  // namespace sunfleck
