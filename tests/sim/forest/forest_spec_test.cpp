// The [forest] table of scene files: what every key does, and what is refused where.

#include "sim/forest/forest_spec.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/sim/forest/expect_refusal.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

ForestSpec spec_from(const std::string& toml) {
  const ConfigTable root = ConfigTable::from_text(toml, "scene.toml");
  ForestSpec spec = read_forest_spec(root.table("forest"));
  root.reject_unread();
  return spec;
}

const std::string kPlot = "[forest]\nplot_width_m = 60\nplot_depth_m = 40.5\n";
const std::string kRule = "[[forest.planting]]\nspecies = \"beech\"\ncount = 10\n";

TEST(ForestSpecFile, EveryKey) {
  const ForestSpec spec = spec_from(R"(
[forest]
name = "test stand"
seed = 42
trees = "crown"
elements_per_tree = 500
detail = 0.5
size_classes = 3
variants = 5
plot_width_m = 60
plot_depth_m = 40.5
[forest.terrain]
elevation_m = 310
slope_deg = 30
aspect_deg = 90
[forest.period]
origin_x_m = -1
origin_y_m = -2
size_x_m = 60
size_y_m = 41
[[forest.planting]]
species = "beech"
count = 20
pattern = "rows"
spacing_m = 2.5
dbh_mean_cm = 30
dbh_sd_cm = 6
[[forest.planting]]
species = "pine"
count = 7
pattern = "random"
)");
  EXPECT_EQ(spec.name, "test stand");
  EXPECT_EQ(spec.seed, 42U);
  EXPECT_EQ(spec.trees, TreeSource::kCrown);
  EXPECT_EQ(spec.elements_per_tree, 500);
  EXPECT_EQ(spec.detail, 0.5);
  EXPECT_EQ(spec.size_classes, 3);
  EXPECT_EQ(spec.variants, 5);
  EXPECT_EQ(spec.plot_width_m, 60.0);
  EXPECT_EQ(spec.plot_depth_m, 40.5);
  EXPECT_EQ(spec.terrain.elevation_m, 310.0);
  EXPECT_DOUBLE_EQ(spec.terrain.slope_rad, kPi / 6);
  EXPECT_DOUBLE_EQ(spec.terrain.aspect_rad, kPi / 2);
  EXPECT_EQ(spec.period, (Period{{-1, -2}, {60, 41}}));
  ASSERT_EQ(spec.planting.size(), 2U);
  EXPECT_EQ(spec.planting[0].species, "beech");
  EXPECT_EQ(spec.planting[0].count, 20);
  EXPECT_EQ(spec.planting[0].pattern, PlantingPattern::kRows);
  EXPECT_EQ(spec.planting[0].spacing_m, 2.5);
  EXPECT_EQ(spec.planting[0].dbh_mean_cm, 30.0);
  EXPECT_EQ(spec.planting[0].dbh_sd_cm, 6.0);
  EXPECT_EQ(spec.planting[1].pattern, PlantingPattern::kRandom);
}

TEST(ForestSpecFile, DefaultsAreThoseOfTheStruct) {
  const ForestSpec spec = spec_from(kPlot + kRule), expected;
  EXPECT_EQ(spec.name, expected.name);
  EXPECT_EQ(spec.seed, expected.seed);
  EXPECT_EQ(spec.trees, expected.trees);
  EXPECT_EQ(spec.elements_per_tree, expected.elements_per_tree);
  EXPECT_EQ(spec.size_classes, expected.size_classes);
  EXPECT_EQ(spec.terrain, expected.terrain);
  EXPECT_FALSE(spec.period);
  EXPECT_EQ(spec.planting[0].pattern, PlantingPattern::kPoissonDisc);
}

TEST(ForestSpecFile, InventoryLiesBesideTheSceneFile) {
  const auto folder = test::scratch_dir() / "scene";
  std::filesystem::create_directories(folder / "data");
  std::ofstream(folder / "data" / "trees.csv") << "id_tree,species,x,y,dbh_cm\n1,beech,0,0,20\n";
  std::ofstream(folder / "scene.toml") << "[forest]\ninventory = \"data/trees.csv\"\n";
  const ForestSpec spec = read_forest_spec(ConfigTable::from_file(folder / "scene.toml").table("forest"));
  ASSERT_EQ(spec.inventory.size(), 1U);
  EXPECT_EQ(spec.inventory[0].species, "beech");
}

TEST(ForestSpecFile, MistakesAreRefusedByKey) {
  struct Case {
    std::string toml, where, problem;
  };
  const std::vector<Case> cases{
      {"[forest]\n", "forest.planting", "no trees"},
      {"[forest]\ninventory = \"a.csv\"\n" + kRule, "forest.inventory", "and planting"},
      {"[forest]\nplot_width_m = 3\n" + kRule, "plot_depth_m", ""},
      {"[forest]\ntrees = \"hedge\"\n", "forest.trees", "hedge"},
      {"[forest]\nseed = -1\n", "forest.seed", "-1"},
      {"[forest]\nelements_per_tree = 0\n", "forest.elements_per_tree", "0"},
      {"[forest]\ndetail = 1.5\n", "forest.detail", "1.5"},
      {"[forest]\ndetail = nan\n", "forest.detail", "nan"},
      {"[forest]\nvariants = 0\n", "forest.variants", "0"},
      {"[forest]\nsize_classes = 2.5\n", "forest.size_classes", ""},
      {"[forest]\n[forest.terrain]\nslope_deg = 81\n", "forest.terrain.slope_deg", "81"},
      {"[forest]\n[forest.period]\nsize_x_m = 0\nsize_y_m = 5\n", "forest.period.size_x_m", "0"},
      {"[forest]\n[forest.period]\nsize_x_m = 5\n", "forest.period.size_y_m", ""},
      {kPlot + "[[forest.planting]]\ncount = 3\n", "species", ""},
      {kPlot + "[[forest.planting]]\nspecies = \"beech\"\n", "count", ""},
      {kPlot + kRule + "pattern = \"hexagons\"\n", "pattern", "hexagons"},
      {kPlot + kRule + "spacing_m = 0\n", "spacing_m", "0"},
      {kPlot + kRule + "dbh_mean_cm = -3\n", "dbh_mean_cm", "-3"},
      {kPlot + kRule + "spacing = 3\n", "spacing", ""},
      {kPlot + "width_m = 60\n" + kRule, "forest.width_m", ""},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.toml);
    test::expect_refusal([&] { spec_from(c.toml); }, ErrorKind::kInvalidInput, c.where, c.problem);
  }
}

}  // namespace
}  // namespace sunfleck
