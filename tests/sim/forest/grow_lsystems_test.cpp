// Forests of shared L-system prototypes: how many there are, which tree takes which, how it is scaled.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "sim/base/parallel.h"
#include "sim/forest/forest_spec.h"
#include "tests/sim/forest/expect_refusal.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

SpeciesLibrary shipped_species() { return SpeciesLibrary::load(test::source_dir() / "configs/species"); }

// The thin trees of the shipped stand, coarse, so that it grows in a second or so.
ForestSpec mixed_stand() {
  ForestSpec spec;
  spec.trees = TreeSource::kLsystem;
  spec.detail = 0.05;
  spec.size_classes = 2;
  spec.variants = 2;
  spec.terrain = {100, 0.3, 0};
  const auto all = read_inventory(test::source_dir() / "configs/scenes/mixed_stand_trees.csv");
  for (const InventoryTree& tree : all) {
    if (tree.dbh_cm < 24) spec.inventory.push_back(tree);
  }
  return spec;
}

TEST(GrowLsystems, TreesShareFewPrototypesAndStandOnTheGround) {
  const ForestSpec spec = mixed_stand();
  const Forest forest = grow_forest(spec, shipped_species(), {});
  ASSERT_EQ(forest.instances.size(), spec.inventory.size());
  EXPECT_LE(forest.prototypes.size(), 3U * 2 * 2);
  EXPECT_GE(forest.prototypes.size(), 3U * 2);
  EXPECT_EQ(forest.materials.size(), 3U);
  std::set<std::uint32_t> used;
  for (std::size_t i = 0; i < forest.instances.size(); ++i) {
    const Instance& instance = forest.instances[i];
    const InventoryTree& tree = spec.inventory[i];
    used.insert(instance.prototype.value);
    EXPECT_EQ(instance.tree, tree.id);
    EXPECT_NEAR(instance.position_m.z, 100 - std::tan(0.3) * tree.y_m, 1e-9);  // falls towards north
    EXPECT_TRUE(forest.prototypes[instance.prototype.value].name.starts_with(tree.species));
  }
  EXPECT_EQ(used.size(), forest.prototypes.size());  // none grown for nothing
}

// Of the instances, those whose tree is over 15 % off its prototype; all scaled as far as that.
std::size_t expect_scaled(const ForestSpec& spec, const SpeciesLibrary& library, const Forest& forest) {
  std::size_t held = 0;
  for (std::size_t i = 0; i < forest.instances.size(); ++i) {
    const Instance& instance = forest.instances[i];
    const InventoryTree& tree = spec.inventory[i];
    const double wanted_m = library.find(tree.species, "test").height_m(tree.dbh_cm);
    const double ratio = wanted_m / measure(forest.prototypes[instance.prototype.value]).height_m;
    EXPECT_NEAR(instance.scale, std::clamp(ratio, 0.85, 1.15), 1e-6);
    held += ratio < 0.85 || ratio > 1.15 ? 1 : 0;
  }
  return held;
}

// Scaled to its own height, or held at 15 % and counted in a note whose advice helps.
TEST(GrowLsystems, ScaledToTheTreesHeight) {
  ForestSpec spec = mixed_stand();
  const SpeciesLibrary library = shipped_species();
  spec.size_classes = 1;
  spec.variants = 1;
  std::vector<std::string> notes;
  std::set<std::string> stages;
  const Forest forest = grow_forest(
      spec, library, {{}, [&](std::string_view stage, double) { stages.emplace(stage); }}, &notes);
  const std::size_t held = expect_scaled(spec, library, forest);
  EXPECT_GT(held, 0U);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_TRUE(notes[0].starts_with(std::to_string(held) + " of ")) << notes[0];
  EXPECT_EQ(stages, std::set<std::string>{"growing trees"});
  const std::string advised = "forest.size_classes = ";
  const std::size_t at = notes[0].find(advised);
  ASSERT_NE(at, std::string::npos) << notes[0];
  spec.size_classes = std::stoi(notes[0].substr(at + advised.size()));
  notes.clear();
  EXPECT_EQ(expect_scaled(spec, library, grow_forest(spec, library, {}, &notes)), 0U);
  EXPECT_TRUE(notes.empty()) << notes[0];
}

// A beech of the shipped stand, of which nothing but the diameter is known.
InventoryTree plain_beech(std::uint32_t id, double dbh_cm) {
  InventoryTree tree;
  tree.id = {id};
  tree.species = "Fagus sylvatica";
  tree.x_m = id;
  tree.dbh_cm = dbh_cm;
  return tree;
}

// A mixed inventory: six trees by diameter, three measured ones between them.
ForestSpec measured_stand() {
  ForestSpec spec;
  spec.detail = 0.1;
  spec.size_classes = 1;
  spec.variants = 2;
  for (std::uint32_t id = 1; id <= 9; ++id) spec.inventory.push_back(plain_beech(id, 25));
  spec.inventory[1].height_m = 30;
  spec.inventory[4].radius_n_m = 2.5;
  spec.inventory[4].radius_s_m = 3.5;
  spec.inventory[7].height_m = 14;
  spec.inventory[7].crown_base_m = 0;
  spec.inventory[7].radius_n_m = spec.inventory[7].radius_e_m = 4;
  spec.inventory[7].leaf_area_density_per_m = 0.2;
  return spec;
}

TEST(GrowLsystems, MeasuredTreesHaveTheirOwnSize) {
  const ForestSpec spec = measured_stand();
  const SpeciesLibrary library = shipped_species();
  const Forest forest = grow_forest(spec, library, {});
  const auto measured = [&](std::size_t i) {
    EXPECT_EQ(forest.instances[i].scale, 1.0F);
    return measure(forest.prototypes[forest.instances[i].prototype.value]);
  };
  const Species& beech = library.find("beech", "test");
  const TreeMeasures tall = measured(1), narrow = measured(4), low = measured(7);
  EXPECT_NEAR(tall.height_m, 30, 0.02 * 30);
  EXPECT_NEAR(tall.dbh_m, 0.25, 1e-4);
  EXPECT_NEAR(tall.leaf_area_m2, beech.leaf_area_m2(25), 1e-4 * tall.leaf_area_m2);
  EXPECT_NEAR(tall.crown_radius_m, beech.crown_radius_m(25), 0.05 * tall.crown_radius_m);
  EXPECT_NEAR(narrow.crown_radius_m, 3, 0.05 * 3);  // the mean of the two
  EXPECT_NEAR(narrow.height_m, beech.height_m(25), 0.02 * narrow.height_m);
  EXPECT_NEAR(low.height_m, 14, 0.02 * 14);
  EXPECT_NEAR(low.crown_radius_m, 4, 0.05 * 4);
  EXPECT_NEAR(low.leaf_area_m2, 0.2 * kPi / 6 * 8 * 8 * 14, 1e-3 * low.leaf_area_m2);  // an ellipsoid
  EXPECT_LT(low.crown_base_m, 0.03 * 14);
}

TEST(GrowLsystems, OtherTreesOfAMeasuredStandShare) {
  const ForestSpec spec = measured_stand();
  const Forest forest = grow_forest(spec, shipped_species(), {});
  std::set<std::uint32_t> shared, own;
  std::set<float> yaws;
  for (std::size_t i = 0; i < spec.inventory.size(); ++i) {
    const bool is_own = i == 1 || i == 4 || i == 7;
    (is_own ? own : shared).insert(forest.instances[i].prototype.value);
    yaws.insert(forest.instances[i].yaw_rad);
  }
  EXPECT_EQ(own.size(), 3U);
  EXPECT_LE(shared.size(), 2U);
  EXPECT_EQ(forest.prototypes.size(), own.size() + shared.size());
  EXPECT_EQ(forest.prototypes[forest.instances[4].prototype.value].name, "Fagus sylvatica 5");
  EXPECT_EQ(yaws.size(), spec.inventory.size());
}

TEST(GrowLsystems, MeasuredTreesAreTheSameForAnyThreads) {
  const SpeciesLibrary library = shipped_species();
  const ForestSpec spec = measured_stand();
  std::string one, two;
  with_threads(1, [&] { one = content_hash(grow_forest(spec, library, {})); });
  with_threads(2, [&] { two = content_hash(grow_forest(spec, library, {})); });
  EXPECT_EQ(one, two);
}

TEST(GrowLsystems, MeasuredTreesTooManyForMemoryAreRefused) {
  ForestSpec spec = measured_stand();
  spec.detail = 1;
  spec.inventory[1].leaf_area_density_per_m = 90;
  spec.inventory[1].radius_n_m = 90;
  test::expect_refusal([&] { grow_forest(spec, shipped_species(), {}); }, ErrorKind::kLimitExceeded,
                       "forest.detail", "measured trees");
}

TEST(GrowLsystems, SameBytesForAnyThreads) {
  const SpeciesLibrary library = shipped_species();
  const ForestSpec spec = mixed_stand();
  std::string one, two;
  with_threads(1, [&] { one = content_hash(grow_forest(spec, library, {})); });
  with_threads(2, [&] { two = content_hash(grow_forest(spec, library, {})); });
  EXPECT_EQ(one, two);
}

TEST(GrowLsystems, BadSpecsAreRefused) {
  struct Case {
    const char *where, *problem;
    std::function<void(ForestSpec&)> spoil;
  };
  const std::vector<Case> cases{
      {"size_classes", "1 to 1000", [](ForestSpec& s) { s.size_classes = 0; }},
      {"variants", "1 to 1000", [](ForestSpec& s) { s.variants = -3; }},
      {"detail", "0.0", [](ForestSpec& s) { s.detail = 0; }},
      {"detail", "nan", [](ForestSpec& s) { s.detail = std::nan(""); }},
      {"tree ", "no foliage area", [](ForestSpec& s) { s.inventory[0].leaf_area_density_per_m = 0; }},
      {"tree ", "upside down",
       [](ForestSpec& s) { s.inventory[0].height_m = 9, s.inventory[0].crown_base_m = 10; }},
      {"tree ", "no size of a tree",
       [](ForestSpec& s) { s.inventory[0].dbh_cm = 1000, s.inventory[0].height_m = 20; }},
      {"tree ", "no grammar", [](ForestSpec& s) { s.inventory[0].species = "pseudotsuga"; }},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.problem);
    ForestSpec spec = mixed_stand();
    c.spoil(spec);
    test::expect_refusal([&] { grow_forest(spec, shipped_species(), {}); }, ErrorKind::kInvalidInput, c.where,
                         c.problem);
  }
}

}  // namespace
}  // namespace sunfleck
