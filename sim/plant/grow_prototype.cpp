// A tree of a species from its grammar: the size goes in as constants, the drawing comes out as foliage and
// wood. The grammar gives the architecture; leaf area, stem diameter and outline are then met exactly. Holds
// for upright trees; the grammars draw stand-grown forms, in which light has shed the lower branches.
#include "sim/base/error.h"
#include "sim/lsystem/lsystem.h"
#include "sim/plant/grow_foliage.h"
#include "sim/plant/grow_reshape.h"
#include "sim/plant/grow_wood.h"
#include "sim/plant/make_prototype.h"

namespace sunfleck {
namespace {

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

// Wood of the drawing without twigs that lost all their organs; as thick as it is with all of them.
std::vector<WoodSegment> wood_below(const lsystem::Drawing& drawing, std::span<const std::size_t> organs) {
  const std::vector<WoodSegment> all = piped_wood(drawing, kPipeExponent, kLivingShare);
  const std::vector<bool> carries = carrying_segments(drawing, organs);
  std::vector<WoodSegment> wood;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (carries[i]) wood.push_back(all[i]);
  return wood;
}

}  // namespace

Prototype grow_prototype(const Species& species, const TreeSize& size, std::uint64_t seed, double detail,
                         const RunControl& control) {
  require_size(size, detail, species.latin);
  if (species.grammar.empty())
    throw_invalid(species.latin + ": grammar", "the species has no grammar to grow",
                  "a `grammar` in its file, or a crown filled with leaves");
  const auto grammar = lsystem::Grammar::load(species.grammar, grammar_constants(species, size));
  lsystem::DeriveOptions options;
  options.seed = seed;
  const auto drawing =
      grammar.interpret(grammar.derive(options, control), lsystem::StartFrame::kTree, options, control);
  if (drawing.organs.empty())
    throw_invalid(species.grammar.string(), "draws no organ for " + species.latin,
                  "an `organs:` line and modules that place them at this size");
  Prototype tree;
  tree.name = species.latin;
  tree.materials = {species.material.name};
  const auto kept = choose_organs(drawing.organs.size(), species.foliage, size.leaf_area_m2, detail, seed);
  tree.foliage = foliage_of(drawing.organs, kept, species.foliage, size.leaf_area_m2);
  tree.wood = wood_below(drawing, kept);
  scale_wood_to_dbh(tree, size.dbh_m);
  reshape_to_size(tree, size);
  scale_wood_to_dbh(tree, size.dbh_m);  // the reshaped stem has another segment at 1.3 m
  validate(tree, species.grammar.string());
  return tree;
}

}  // namespace sunfleck
