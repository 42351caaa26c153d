// Plot outlines, and what stands around a plot.
#include "sim/forest/surroundings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "sim/base/random.h"
#include "sim/forest/plot_polygon.h"
#include "tests/sim/forest/expect_refusal.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

TEST(PlotPolygon, AreaAndPointsOfAnL) {
  // An L of 3 x 3 without its upper right 1 x 1, listed clockwise, closed.
  const PlotPolygon plot = parse_plot_polygon("x,y\n0,0\n0,3\n2,3\n2,2\n3,2\n3,0\n0,0\n", "p.csv");
  EXPECT_NEAR(area_m2(plot), 8, 1e-12);
  EXPECT_TRUE(contains(plot, {2.9, 1.9}));
  EXPECT_FALSE(contains(plot, {2.1, 2.1}));
  EXPECT_FALSE(contains(plot, {-1e-9, 1}));
}

TEST(PlotPolygon, FarFromTheOriginLosesNothing) {
  const PlotPolygon plot = rectangle({6e5, 5.5e6}, {6e5 + 20, 5.5e6 + 30});
  EXPECT_NEAR(area_m2(plot), 600, 1e-6);
}

TEST(PlotPolygon, RefusesWhatIsNoOutline) {
  test::expect_refusal([] { parse_plot_polygon("x,y\n0,0\n1,1\n", "p.csv"); }, ErrorKind::kInvalidInput,
                       "p.csv", "three corners");
  test::expect_refusal([] { parse_plot_polygon("x,y\n0,0\n2,2\n2,0\n0,2\n", "p.csv"); },
                       ErrorKind::kInvalidInput, "p.csv:4", "crosses");
  test::expect_refusal([] { parse_plot_polygon("x,y\n0,0\n1,0\n2,0\n", "p.csv"); }, ErrorKind::kInvalidInput,
                       "p.csv", "");
  test::expect_refusal([] { read_plot_polygon("absent.csv"); }, ErrorKind::kNotFound, "absent", "read");
}

std::vector<InventoryTree> plot_trees(int count, double size_m) {
  std::vector<InventoryTree> trees;
  for (int i = 0; i < count; ++i) {
    RandomStream random(5, static_cast<std::uint64_t>(i), RandomPurpose::kTestScene);
    InventoryTree tree;
    tree.id = {static_cast<std::uint32_t>(i + 1)};
    tree.species = "beech";
    tree.x_m = random.uniform(0, size_m);
    tree.y_m = random.uniform(0, size_m);
    tree.dbh_cm = 10 + i;
    tree.height_m = 20;
    tree.radius_e_m = 3;
    tree.radius_w_m = 1;
    trees.push_back(tree);
  }
  return trees;
}

double basal_area(const std::vector<InventoryTree>& trees, bool added) {
  double sum = 0;
  for (const InventoryTree& tree : trees)
    if (is_virtual(tree.id) == added) sum += tree.dbh_cm * tree.dbh_cm;
  return sum;
}

TEST(Surroundings, SimilarTreesKeepDensityAndBasalArea) {
  const auto trees = plot_trees(50, 50);
  const PlotPolygon plot = rectangle({0, 0}, {50, 50});
  const SurroundedStand stand = surround(trees, plot, Surroundings::kSimilar, 25, 3);
  // The strip is three times the plot; donors go round in whole rounds of the plot's trees.
  EXPECT_EQ(stand.trees.size(), 200u);
  EXPECT_NEAR(basal_area(stand.trees, true), 3 * basal_area(stand.trees, false), 1e-6);
  std::set<std::uint32_t> numbers;
  for (const InventoryTree& tree : stand.trees) {
    EXPECT_TRUE(numbers.insert(tree.id.value).second);
    if (!is_virtual(tree.id)) continue;
    EXPECT_FALSE(contains(plot, {tree.x_m, tree.y_m}));
    EXPECT_TRUE(tree.copy_of.has_value());
  }
  const SurroundedStand again = surround(trees, plot, Surroundings::kSimilar, 25, 3);
  for (std::size_t i = 0; i < stand.trees.size(); ++i) EXPECT_EQ(stand.trees[i].x_m, again.trees[i].x_m);
}

TEST(Surroundings, PeriodicFillsTheRectangleOfARaggedPlot) {
  const PlotPolygon half = parse_plot_polygon("x,y\n0,0\n40,0\n0,40\n", "p.csv");  // half of its rectangle
  std::vector<InventoryTree> trees;
  for (const InventoryTree& tree : plot_trees(80, 40))
    if (contains(half, {tree.x_m, tree.y_m})) trees.push_back(tree);
  const SurroundedStand stand = surround(trees, half, Surroundings::kPeriodic, 0, 1);
  ASSERT_TRUE(stand.period.has_value());
  EXPECT_EQ(stand.period->size_m, Vec2(40, 40));
  EXPECT_NEAR(static_cast<double>(stand.trees.size()), 2.0 * static_cast<double>(trees.size()), 1.0);
}

TEST(Surroundings, MirrorImagesSwapTheCrown) {
  std::vector<InventoryTree> trees = plot_trees(1, 1);
  trees[0].x_m = 2, trees[0].y_m = 25;
  const SurroundedStand stand = surround(trees, rectangle({0, 0}, {50, 50}), Surroundings::kMirrored, 10, 1);
  ASSERT_EQ(stand.trees.size(), 2u);  // only the western side is near
  EXPECT_NEAR(stand.trees[1].x_m, -2, 1e-12);
  EXPECT_EQ(stand.trees[1].radius_e_m, 1.0);
  EXPECT_EQ(stand.trees[1].radius_w_m, 3.0);
  test::expect_refusal(
      [&] {
        surround(trees, parse_plot_polygon("x,y\n0,0\n40,0\n0,40\n", "p.csv"), Surroundings::kMirrored, 10,
                 1);
      },
      ErrorKind::kInvalidInput, "surroundings", "rectangle");
}

TEST(Surroundings, GrowAsCopiesOfTheirOriginals) {
  const auto library = SpeciesLibrary::load(test::source_dir() / "configs/species");
  ForestSpec spec;
  spec.inventory = plot_trees(6, 20);
  spec.trees = TreeSource::kCrown;
  spec.elements_per_tree = 50;
  spec.surroundings = Surroundings::kSimilar;
  spec.surroundings_width_m = 10;
  std::vector<std::string> notes;
  const Forest forest = grow_forest(spec, library, {}, &notes);
  EXPECT_EQ(forest.prototypes.size(), 6u);
  EXPECT_GT(forest.instances.size(), 6u);
  ASSERT_FALSE(notes.empty());
  spec.period = Period{{0, 0}, {20, 20}};
  test::expect_refusal([&] { grow_forest(spec, library, {}); }, ErrorKind::kInvalidInput, "period",
                       "surroundings");
}

// Clumps of radius r: elements of one clump lie within 2 r; without clumps they do not.
TEST(LeafClumps, KeepTheirElementsTogether) {
  const auto library = SpeciesLibrary::load(test::source_dir() / "configs/species");
  ForestSpec spec;
  spec.inventory = plot_trees(1, 20);
  spec.trees = TreeSource::kCrown;
  spec.elements_per_tree = 400;
  spec.clumps = {0.25, 20};
  const Forest forest = grow_forest(spec, library, {});
  const auto& foliage = forest.prototypes[0].foliage;
  for (std::size_t i = 0; i < foliage.size(); ++i)
    EXPECT_LE(glm::distance(foliage[i].centre_m, foliage[i - i % 20].centre_m), 0.5f + 1e-4f);
  double area = 0;
  for (const FoliageElement& e : foliage) area += e.area_m2;
  spec.leaf_area_factor = 2;
  double twice = 0;
  const Forest doubled = grow_forest(spec, library, {});
  for (const FoliageElement& e : doubled.prototypes[0].foliage) twice += e.area_m2;
  EXPECT_NEAR(twice / area, 2, 1e-5);
}

}  // namespace
}  // namespace sunfleck
