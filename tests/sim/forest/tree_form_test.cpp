// Trees that grew up alone or in a stand, from planting rules and inventories, and trees that grow up in
// light.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/forest/forest_spec.h"
#include "sim/plant/make_prototype.h"
#include "tests/sim/forest/expect_refusal.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

const SpeciesLibrary& library() {
  static const SpeciesLibrary shipped = SpeciesLibrary::load(test::source_dir() / "configs/species");
  return shipped;
}

ForestSpec spec_from(const std::string& toml) {
  const ConfigTable root = ConfigTable::from_text(toml, "scene.toml");
  ForestSpec spec = read_forest_spec(root.table("forest"));
  root.reject_unread();
  return spec;
}

std::string planted(const std::string& forest_keys, const std::string& rule_keys,
                    const std::string& species = "beech") {
  return "[forest]\nplot_width_m = 20\nplot_depth_m = 20\ndetail = 0.02\n" + forest_keys +
         "[[forest.planting]]\nspecies = \"" + species +
         "\"\ncount = 2\npattern = \"rows\"\nspacing_m = 10\ndbh_mean_cm = 30\ndbh_sd_cm = 0\n" + rule_keys;
}

// The crown of an open-grown tree is long and wide; its measures are those of the allometry to the 10 % that
// prototypes are held to.
TEST(TreeForm, OpenGrownTreesAreTheirAllometry) {
  for (const char* name : {"beech", "Picea abies", "Quercus robur"}) {
    SCOPED_TRACE(name);
    const Species& species = library().find(name, "test");
    const Forest open = grow_forest(spec_from(planted("", "form = \"open\"\n", name)), library(), {});
    const Forest stand = grow_forest(spec_from(planted("", "", name)), library(), {});
    const TreeMeasures wide = measure(open.prototypes.at(0)), narrow = measure(stand.prototypes.at(0));
    const TreeSize size = expected_size(species, 30, TreeForm::kOpenGrown);
    EXPECT_NEAR(wide.height_m, size.height_m, 0.1 * size.height_m);
    EXPECT_NEAR(wide.crown_radius_m, size.crown_radius_m, 0.1 * size.crown_radius_m);
    EXPECT_LT(wide.crown_base_m, 0.6 * narrow.crown_base_m);
    EXPECT_NE(open.prototypes[0].name.find("open-grown"), std::string::npos);
  }
}

TEST(TreeForm, TheForestsFormHoldsWhereARuleStatesNone) {
  const ForestSpec spec =
      spec_from(planted("form = \"open\"\n", "") +
                "[[forest.planting]]\nspecies = \"beech\"\ncount = 1\nform = \"stand\"\n");
  EXPECT_EQ(spec.planting.at(0).form, TreeForm::kOpenGrown);
  EXPECT_EQ(spec.planting.at(1).form, TreeForm::kStandGrown);
  EXPECT_EQ(spec_from(planted("", "")).planting.at(0).form, TreeForm::kStandGrown);
}

TEST(TreeForm, InventoriesHaveAColumnForIt) {
  const std::string rows =
      "id_tree,species,x,y,dbh_cm,form\n1,fasy,0,0,30,open\n2,fasy,9,0,30,stand\n"
      "3,fasy,0,9,30,\n4,fasy,9,9,30,NA\n";
  const auto trees = parse_inventory(rows, "t.csv");
  EXPECT_EQ(trees.at(0).form, TreeForm::kOpenGrown);
  EXPECT_EQ(trees.at(1).form, TreeForm::kStandGrown);
  EXPECT_EQ(trees.at(2).form, TreeForm::kStandGrown);
  EXPECT_EQ(parse_inventory(rows, "t.csv", TreeForm::kOpenGrown).at(3).form, TreeForm::kOpenGrown);
  test::expect_refusal(
      [] { parse_inventory("id_tree,species,x,y,dbh_cm,form\n1,fasy,0,0,30,wild\n", "t.csv"); },
      ErrorKind::kInvalidInput, "t.csv:2", "wild");
}

// The law of harvested trees holds for grammars too: 5 % as for every leaf area.
TEST(TreeForm, LeafAreaByAllometry) {
  const Species& beech = library().find("fasy", "test");
  const Forest dense =
      grow_forest(spec_from(planted("leaf_area = \"allometry\"\n", "form = \"open\"\n")), library(), {});
  const TreeSize size = expected_size(beech, 30, TreeForm::kOpenGrown);
  const double wanted_m2 = beech.leaf_area_m2(30, size.height_m);
  EXPECT_GT(wanted_m2, 1.5 * size.leaf_area_m2);
  EXPECT_NEAR(measure(dense.prototypes.at(0)).leaf_area_m2, wanted_m2, 0.05 * wanted_m2);
}

TEST(TreeForm, LeafAreaByFactor) {
  const Forest twice =
      grow_forest(spec_from(planted("leaf_area_factor = 2\n", "form = \"open\"\n")), library(), {});
  const double wanted_m2 =
      2 * expected_size(library().find("fasy", "test"), 30, TreeForm::kOpenGrown).leaf_area_m2;
  EXPECT_NEAR(measure(twice.prototypes.at(0)).leaf_area_m2, wanted_m2, 0.05 * wanted_m2);
}

// Crowns filled with leaves take what the row does not state from the same allometry.
TEST(TreeForm, CrownsTakeTheirMissingMeasuresFromIt) {
  ForestSpec spec;
  spec.trees = TreeSource::kCrown;
  spec.elements_per_tree = 2000;
  spec.inventory =
      parse_inventory("id_tree,species,x,y,dbh_cm,form\n1,fasy,0,0,30,open\n2,fasy,30,0,30,stand\n", "t.csv");
  const Forest forest = grow_forest(spec, library(), {});
  const TreeMeasures open = measure(forest.prototypes.at(0)), stand = measure(forest.prototypes.at(1));
  EXPECT_LT(open.crown_base_m, 0.4 * stand.crown_base_m);
  const Species& beech = library().find("fasy", "test");
  EXPECT_NEAR(open.height_m, expected_size(beech, 30, TreeForm::kOpenGrown).height_m, 0.05);
}

TEST(TreeForm, RefusesSpeciesItDoesNotKnowSo) {
  ForestSpec spec;
  spec.trees = TreeSource::kCrown;
  spec.inventory =
      parse_inventory("id_tree,species,x,y,dbh_cm,form\n7,Pseudotsuga menziesii,0,0,30,open\n", "t.csv");
  test::expect_refusal([&] { grow_forest(spec, library(), {}); }, ErrorKind::kInvalidInput, "tree 7",
                       "open-grown");
  EXPECT_THROW(spec_from(planted("form = \"wild\"\n", "")), Error);
}

std::string in_light(const std::string& keys, const std::string& species = "beech") {
  return "[forest]\nplot_width_m = 4\nplot_depth_m = 4\n[forest.grow_in_light]\n" + keys +
         "[[forest.planting]]\nspecies = \"" + species + "\"\ncount = 4\npattern = \"rows\"\nspacing_m = 2\n";
}

TEST(GrowInLightScene, GrowsAStandOfItsOwnTrees) {
  std::vector<std::string> notes;
  const ForestSpec spec = spec_from(in_light("years = 9\n"));
  const Forest forest = grow_forest(spec, library(), {}, &notes);
  ASSERT_EQ(forest.instances.size(), 4u);
  EXPECT_EQ(forest.prototypes.size(), 4u);
  EXPECT_EQ(forest.prototypes[1].name, "Fagus sylvatica 2");
  EXPECT_EQ(forest.instances[3].position_m, Vec3(3, 3, 0));
  EXPECT_NE(measure(forest.prototypes[0]).leaf_area_m2, measure(forest.prototypes[1]).leaf_area_m2);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("4 trees grew 9 years in light"), std::string::npos) << notes[0];
  EXPECT_EQ(content_hash(grow_forest(spec, library(), {})), content_hash(forest));
  ForestSpec other = spec;
  other.seed = 2;
  EXPECT_NE(content_hash(grow_forest(other, library(), {})), content_hash(forest));
}

TEST(GrowInLightScene, SaysWhatItCannotDo) {
  const auto refuse = [](const ForestSpec& spec, const std::string& where, const std::string& problem) {
    test::expect_refusal([&] { grow_forest(spec, library(), {}); }, ErrorKind::kInvalidInput, where, problem);
  };
  refuse(spec_from(in_light("years = 5\n", "Picea abies")), "forest.planting[0]",
         "no grammar that grows in light");
  refuse(spec_from(in_light("light = \"grid\"\nyears = 2\n")), "forest.grow_in_light.light", "nobody");
  refuse(spec_from(in_light("years = 2\n") + "[forest.terrain]\nslope_deg = 10\n"), "slope_deg", "level");
  ForestSpec spec = spec_from(in_light("years = 2\n"));
  spec.trees = TreeSource::kCrown;
  refuse(spec, "forest.grow_in_light", "grammars");
  spec.trees = TreeSource::kLsystem;
  spec.detail = 0.5;
  refuse(spec, "forest.detail", "size");
  for (const char* wrong : {"years = 0\n", "years = 201\n", "cell_m = 0.01\n", "stop_height_m = -1\n",
                            "light = \"sun\"\n", "speed = 2\n"})
    EXPECT_THROW(spec_from(in_light(wrong)), Error) << wrong;
}

}  // namespace
}  // namespace sunfleck
