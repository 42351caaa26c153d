// Measured crowns filled by grown trees: leaf area, the shape, the wood, notes, the same for any number of
// threads.
#include "sim/forest/crown_filling.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/plant/crown_shape.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

SpeciesLibrary library() { return SpeciesLibrary::load(test::source_dir() / "configs/species"); }

CrownShape lopsided() {
  CrownShape crown;
  crown.height_m = 18, crown.base_m = 5, crown.widest_m = 10;
  crown.radius_nesw_m = {4, 2.5, 1.5, 5};
  crown.dbh_m = 0.24;
  return crown;
}

double quadrant_reach_m(const Prototype& tree, const Vec2& towards) {
  double reach = 0;
  for (const FoliageElement& e : tree.foliage)
    reach = std::max(reach, glm::dot(Vec2(e.centre_m.x, e.centre_m.y), towards));
  return reach;
}

TEST(CrownReach, IsTheSurfaceOfTheCrown) {
  const CrownShape crown = lopsided();
  EXPECT_NEAR(crown_reach_m(crown, 10, {0, 1}), 4, 1e-12);
  EXPECT_NEAR(crown_reach_m(crown, 10, {-1, 0}), 5, 1e-12);
  EXPECT_NEAR(crown_reach_m(crown, 14, {1, 0}), 2.5 * std::sqrt(0.75), 1e-12);  // half of the way up
  EXPECT_EQ(crown_reach_m(crown, 4.9, {1, 0}), 0);
  EXPECT_EQ(crown_reach_m(crown, 18.1, {1, 0}), 0);
  for (int k = 0; k < 200; ++k) {
    const double turn = 0.1 * k, z = 5.01 + 0.0648 * k;
    const Vec2 towards(std::cos(turn), std::sin(turn));
    const double reach = crown_reach_m(crown, z, towards);
    EXPECT_TRUE(inside_crown(crown, Vec3(0.999 * reach * towards, z), 1e-9)) << k;
    EXPECT_FALSE(inside_crown(crown, Vec3(1.001 * reach * towards, z), 1e-9)) << k;
  }
}

class GrownCrown : public ::testing::TestWithParam<const char*> {};

TEST_P(GrownCrown, FillsTheMeasuredShapeWithTheStatedArea) {
  const SpeciesLibrary species = library();
  const CrownShape crown = lopsided();
  const Prototype tree = grown_crown(species.find(GetParam(), "test"), crown, 90, 3000, 5, {});
  validate(tree, "grown crown");
  EXPECT_NEAR(leaf_area_m2(tree), 90, 1e-3);  // sums of floats
  EXPECT_LE(tree.foliage.size(), 3300u);      // about as many as asked for
  EXPECT_GE(tree.foliage.size(), 1000u);
  double low = 1e9, high = 0;
  for (const FoliageElement& e : tree.foliage) {
    EXPECT_TRUE(inside_crown(crown, Vec3(e.centre_m), 1e-4));
    low = std::min(low, double{e.centre_m.z}), high = std::max(high, double{e.centre_m.z});
  }
  EXPECT_NEAR(low, crown.base_m, 1e-3);
  EXPECT_NEAR(high, crown.height_m, 1e-3);
  // The outline is smoothed outwards over cells, and few elements are where it is widest: three quarters.
  const Vec2 sides[] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_GT(quadrant_reach_m(tree, sides[i]), 0.7 * crown.radius_nesw_m[i]) << i;
    EXPECT_LE(quadrant_reach_m(tree, sides[i]), 1.0001 * crown.radius_nesw_m[i]) << i;
  }
  ASSERT_FALSE(tree.wood.empty());
  EXPECT_NEAR(measure(tree).dbh_m, crown.dbh_m, 0.05 * crown.dbh_m);
  for (const WoodSegment& w : tree.wood) {  // wood follows
    for (const Vec3f& p : {w.from_m, w.to_m}) {
      if (p.z < crown.base_m || p.z > crown.height_m) continue;
      EXPECT_TRUE(inside_crown(crown, Vec3(p), 1e-4));
    }
    EXPECT_LE(w.to_m.z, crown.height_m * 1.1);
  }
}
INSTANTIATE_TEST_SUITE_P(Species, GrownCrown, ::testing::Values("beech", "Picea abies", "Pinus sylvestris"));

ForestSpec two_trees() {
  ForestSpec spec;
  for (int i = 0; i < 2; ++i) {
    InventoryTree tree;
    tree.id = {static_cast<std::uint32_t>(i + 1)};
    tree.species = i == 0 ? "beech" : "Pseudotsuga menziesii";
    tree.x_m = 8.0 * i;
    tree.dbh_cm = 20;
    tree.height_m = 15, tree.crown_base_m = 0, tree.widest_m = 7;  // a crown to the ground
    tree.radius_n_m = 3, tree.radius_e_m = 2, tree.radius_s_m = 1, tree.radius_w_m = 2;
    tree.leaf_area_density_per_m = 0.5;
    spec.inventory.push_back(tree);
  }
  spec.trees = TreeSource::kCrown;
  spec.filling = CrownFilling::kGrown;
  spec.elements_per_tree = 500;
  return spec;
}

TEST(GrownCrowns, DouglasFirHasNoGrammarAndKeepsItsLeaves) {
  std::vector<std::string> notes;
  ForestSpec spec = two_trees();
  const Forest grown = grow_forest(spec, library(), {}, &notes);
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_NE(notes[0].find("Pseudotsuga menziesii has no grammar"), std::string::npos) << notes[0];
  EXPECT_NE(notes[0].find("1 tree)"), std::string::npos) << notes[0];
  EXPECT_NE(notes[1].find("1 tree grown into their crowns, none shared"), std::string::npos) << notes[1];
  spec.filling = CrownFilling::kLeaves;
  const Forest filled = grow_forest(spec, library(), {}, nullptr);
  EXPECT_EQ(grown.prototypes[1].foliage.size(), filled.prototypes[1].foliage.size());
  for (std::size_t t = 0; t < 2; ++t)  // the area does not depend on the filling
    EXPECT_NEAR(leaf_area_m2(grown.prototypes[t]), leaf_area_m2(filled.prototypes[t]), 1e-2);
}

TEST(GrownCrowns, SameForAnyNumberOfThreads) {
  ForestSpec spec = two_trees();
  spec.inventory[1].species = "Picea abies";
  std::string one, two;
  with_threads(1, [&] { one = content_hash(grow_forest(spec, library(), {}, nullptr)); });
  with_threads(2, [&] { two = content_hash(grow_forest(spec, library(), {}, nullptr)); });
  EXPECT_EQ(one, two);
  spec.seed = 2;
  EXPECT_NE(content_hash(grow_forest(spec, library(), {}, nullptr)), one);
}

}  // namespace
}  // namespace sunfleck
