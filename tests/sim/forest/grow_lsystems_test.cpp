// Forests of shared L-system prototypes: how many there are, which tree takes which, how it is scaled.

#include <gtest/gtest.h>

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

// Scaled to its own height, or held at 15 %: then the tree is farther off than that.
TEST(GrowLsystems, ScaledToTheTreesHeight) {
  const ForestSpec spec = mixed_stand();
  const SpeciesLibrary library = shipped_species();
  std::string said;
  const Forest forest =
      grow_forest(spec, library, {{}, [&](std::string_view stage, double) { said = stage; }});
  std::size_t held = 0;
  for (std::size_t i = 0; i < forest.instances.size(); ++i) {
    const Instance& instance = forest.instances[i];
    const InventoryTree& tree = spec.inventory[i];
    const double wanted_m = library.find(tree.species, "test").height_m(tree.dbh_cm);
    const double ratio = wanted_m / measure(forest.prototypes[instance.prototype.value]).height_m;
    EXPECT_NEAR(instance.scale, std::clamp(ratio, 0.85, 1.15), 1e-6);
    held += ratio < 0.85 || ratio > 1.15 ? 1 : 0;
  }
  if (held > 0) {
    EXPECT_TRUE(said.starts_with(std::to_string(held) + " of ")) << said;
  } else {
    EXPECT_EQ(said, "growing trees");
  }
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
