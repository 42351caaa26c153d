// Trees too small for the inventory: where it stops, how many are missing, what grows; natural crowns by one
// key.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/base/error.h"
#include "sim/forest/realism.h"
#include "sim/forest/understorey.h"
#include "sim/plant/make_prototype.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

std::vector<InventoryTree> trees_of(const std::vector<double>& dbh_cm) {
  std::vector<InventoryTree> trees;
  for (std::size_t i = 0; i < dbh_cm.size(); ++i) {
    InventoryTree tree;
    tree.id = {static_cast<std::uint32_t>(i + 1)};
    tree.species = "beech";
    tree.dbh_cm = dbh_cm[i];
    tree.x_m = 3.0 + 5 * static_cast<double>(i % 6), tree.y_m = 3.0 + 5 * static_cast<double>(i / 6);
    trees.push_back(tree);
  }
  return trees;
}

// Callipered from 10 cm: many just above it, one below, some thicker.
const std::vector<double> kCut{8, 10.2, 10.5, 11, 11.2, 11.9, 12.1, 13, 14, 16, 18, 21, 26, 33, 45};

TEST(Understorey, FindsTheCalliperingLimit) {
  ASSERT_TRUE(calliper_limit_cm(trees_of(kCut)).has_value());
  EXPECT_EQ(*calliper_limit_cm(trees_of(kCut)), 10);
  EXPECT_FALSE(calliper_limit_cm(trees_of({15, 18, 19, 21, 22, 23, 24, 26})).has_value());  // bell-shaped
  EXPECT_FALSE(calliper_limit_cm(trees_of({40, 50, 60})).has_value());
}

// Ten stems stand between 10 and 20 cm; with q = 1.4 per 5 cm, 10 cm hold a share 1 - 1.4^-2 of all above
// the limit, and from 5 cm to it grow 1.4 - 1 times as many: 10 * 0.4 / (1 - 1 / 1.96), less the one
// measured.
TEST(Understorey, CountsByTheGeometricSeries) {
  Understorey options;
  options.smallest_dbh_cm = 5;
  EXPECT_NEAR(missing_stems(trees_of(kCut), 10, options), 10 * 0.4 / (1 - 1 / 1.96) - 1, 1e-9);
}

TEST(Understorey, GrowsInsideThePlotAndSaysSo) {
  const SpeciesLibrary species = SpeciesLibrary::load(test::source_dir() / "configs/species");
  ForestSpec spec;
  spec.inventory = trees_of(kCut);
  spec.trees = TreeSource::kCrown;
  spec.understorey.add = true;
  spec.plot = rectangle({0, 0}, {36, 20});
  std::vector<std::string> notes;
  const Forest forest = grow_forest(spec, species, {}, &notes);
  const auto added = forest.instances.size() - kCut.size();
  EXPECT_EQ(added,
            static_cast<std::size_t>(std::lround(missing_stems(spec.inventory, 10, spec.understorey))));
  for (const Instance& tree : forest.instances) {
    if (!is_virtual(tree.tree)) continue;
    EXPECT_TRUE(contains(*spec.plot, Vec2(tree.position_m)));
  }
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("too small for the inventory"), std::string::npos);
}

TEST(Understorey, RefusesOptionsOutOfRange) {
  const SpeciesLibrary species = SpeciesLibrary::load(test::source_dir() / "configs/species");
  Understorey options;
  options.stems_ratio_per_5_cm = 1;
  std::vector<std::string> notes;
  EXPECT_THROW(understorey_trees(trees_of(kCut), rectangle({0, 0}, {36, 20}), options, species, 1, notes),
               Error);
}

// One word sets it all; a key beside it wins.
TEST(Realism, OneKeyAndItsExceptions) {
  const std::string rest =
      "plot_width_m = 20\nplot_depth_m = 20\n[[planting]]\nspecies = \"beech\"\ncount = 3\n";
  const auto natural =
      read_forest_spec(ConfigTable::from_text("realism = \"natural\"\nrim_power = 2\n" + rest, "a.toml"));
  EXPECT_EQ(natural.trees, TreeSource::kCrown);
  EXPECT_EQ(natural.leaf_area, LeafAreaSource::kAllometry);
  EXPECT_EQ(natural.rim_power, 2);
  EXPECT_EQ(natural.height_power, 1);
  EXPECT_TRUE(natural.understorey.add);
  const auto plain = read_forest_spec(ConfigTable::from_text(rest, "a.toml"));
  EXPECT_EQ(plain.trees, TreeSource::kLsystem);
  EXPECT_EQ(plain.branch_share, 0);
  EXPECT_FALSE(plain.understorey.add);
}

// A ball of a crown holds leaf area t (1 - t) at a share t of its length; times t that is the beta
// distribution (3, 2): mean 0.6, standard deviation 0.2, so that 20,000 leaves tell the mean to 0.0014 (four
// of them).
TEST(Realism, DensityGrowsWithTheHeightAboveTheCrownsBase) {
  const SpeciesLibrary library = SpeciesLibrary::load(test::source_dir() / "configs/species");
  CrownShape crown;
  crown.height_m = 20, crown.base_m = 10, crown.widest_m = 15;
  crown.radius_nesw_m = {5, 5, 5, 5};
  crown.dbh_m = 0;
  CrownFill fill;
  fill.elements = 20000;
  const auto mean_height = [&] {
    const Prototype tree = crown_prototype(library.find("beech", "test"), crown, fill);
    double sum = 0;
    for (const FoliageElement& e : tree.foliage) sum += (e.centre_m.z - 10) / 10 / fill.elements;
    return sum;
  };
  EXPECT_NEAR(mean_height(), 0.5, 0.0064);
  fill.height_power = 1;
  EXPECT_NEAR(mean_height(), 0.6, 0.0057);
  fill.height_power = 2;  // beta (4, 2)
  EXPECT_NEAR(mean_height(), 2.0 / 3, 0.0051);
  fill.height_power = 21;
  EXPECT_THROW(mean_height(), Error);
}

// Leaf area by the harvest law, branches with the share asked for (half the side of each rod).
TEST(Realism, LeavesAndBranchesHaveTheAreaAskedFor) {
  const SpeciesLibrary species = SpeciesLibrary::load(test::source_dir() / "configs/species");
  ForestSpec spec;
  spec.inventory = trees_of({30});
  spec.inventory[0].height_m = 22;
  apply(Realism::kNatural, spec);
  spec.understorey.add = false;
  const Prototype tree = grow_forest(spec, species, {}).prototypes.at(0);
  const double leaves_m2 = 0.648 * std::pow(30, 2.43) * std::pow(22, -0.913);
  EXPECT_NEAR(leaf_area_m2(tree) / leaves_m2, 1, 1e-5);
  double branches_m2 = 0;
  for (const WoodSegment& w : tree.wood)
    if (w.from_m.x != 0 || w.from_m.y != 0)
      branches_m2 += 0.5 * kPi * (w.radius_from_m + w.radius_to_m) * glm::length(w.to_m - w.from_m);
  EXPECT_NEAR(branches_m2 / (0.1 * leaves_m2), 1, 1e-3);
}

}  // namespace
}  // namespace sunfleck
