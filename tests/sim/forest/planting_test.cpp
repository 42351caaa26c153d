// Planting keeps the distances it promises, spreads trees evenly, gives the diameters asked for, and says so
// when trees do not fit. All figures are of fixed seeds: the tests are deterministic.

#include "sim/forest/planting.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/forest/expect_refusal.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

ForestSpec plot_with(std::vector<PlantingRule> rules, double width_m = 60, double depth_m = 40) {
  ForestSpec spec;
  spec.planting = std::move(rules);
  spec.plot_width_m = width_m;
  spec.plot_depth_m = depth_m;
  return spec;
}

double distance_m(const InventoryTree& a, const InventoryTree& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
}

double least_distance_m(const std::vector<InventoryTree>& trees) {
  double least_m = 1e9;
  for (std::size_t i = 0; i < trees.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) least_m = std::min(least_m, distance_m(trees[i], trees[j]));
  }
  return least_m;
}

TEST(Planting, PoissonDiscKeepsItsDistanceInsideThePlot) {
  const auto planted =
      plant_trees(plot_with({{"beech", 150, PlantingPattern::kPoissonDisc, 2.5, 25, 5}}), {});
  ASSERT_EQ(planted.trees.size(), 150U);
  EXPECT_TRUE(planted.shortfalls.empty());
  EXPECT_GE(least_distance_m(planted.trees), 2.5);
  for (std::size_t i = 0; i < planted.trees.size(); ++i) {
    const InventoryTree& tree = planted.trees[i];
    EXPECT_EQ(tree.id.value, i + 1);
    EXPECT_TRUE(tree.x_m >= 0 && tree.x_m <= 60 && tree.y_m >= 0 && tree.y_m <= 40);
  }
}

// Darts saturate when 0.547 of the plane is covered by discs of half the spacing (Renyi's parking in two
// dimensions): 0.547 * 2400 / (pi * 2.5^2) = 67 discs of spacing 5 m, and more at the edges of a plot of
// 60 m x 40 m, where half a disc may stick out: (65 x 45) gives 81. Giving up early loses up to a tenth.
TEST(Planting, FullPlotIsSaidAndNearlySaturated) {
  const auto planted = plant_trees(plot_with({{"beech", 1000, PlantingPattern::kPoissonDisc, 5, 25, 5}}), {});
  EXPECT_GE(planted.trees.size(), 67U);
  EXPECT_LE(planted.trees.size(), 90U);
  ASSERT_EQ(planted.shortfalls.size(), 1U);
  EXPECT_NE(planted.shortfalls[0].find("of 1000 beech fit"), std::string::npos) << planted.shortfalls[0];
}

TEST(Planting, RulesShareThePlot) {
  const auto planted = plant_trees(plot_with({{"beech", 60, PlantingPattern::kPoissonDisc, 3, 25, 5},
                                              {"pine", 40, PlantingPattern::kPoissonDisc, 3, 35, 5}}),
                                   {});
  ASSERT_EQ(planted.trees.size(), 100U);
  EXPECT_EQ(planted.trees[59].species, "beech");
  EXPECT_EQ(planted.trees[60].species, "pine");
  EXPECT_GE(least_distance_m(planted.trees), 3.0);
}

// Step 10 m on 60 m x 40 m: centres at 5, 15, ... 55 and 5 ... 35: 24 places.
TEST(Planting, RowsFillALattice) {
  const auto planted = plant_trees(plot_with({{"pine", 20, PlantingPattern::kRows, 10, 25, 5},
                                              {"spruce", 20, PlantingPattern::kRows, 10, 25, 5}}),
                                   {});
  ASSERT_EQ(planted.trees.size(), 24U);
  EXPECT_EQ(planted.shortfalls.size(), 1U);
  EXPECT_DOUBLE_EQ(planted.trees[0].x_m, 5);
  EXPECT_DOUBLE_EQ(planted.trees[7].x_m, 15);
  EXPECT_DOUBLE_EQ(planted.trees[7].y_m, 15);
  EXPECT_EQ(planted.trees[20].species, "spruce");
  EXPECT_DOUBLE_EQ(least_distance_m(planted.trees), 10);
}

// Each of n = 4000 random places falls in a quarter of the plot with p = 1/4: sd sqrt(n p q) = 27; 4 sd
// = 110 (chance 6e-5 per quarter, seed 1).
TEST(Planting, RandomIsEven) {
  const auto planted = plant_trees(plot_with({{"pine", 4000, PlantingPattern::kRandom, 0, 25, 5}}), {});
  ASSERT_EQ(planted.trees.size(), 4000U);
  int quarters[4] = {};
  for (const InventoryTree& tree : planted.trees)
    ++quarters[(tree.x_m < 30 ? 0 : 1) + (tree.y_m < 20 ? 0 : 2)];
  for (const int count : quarters) EXPECT_NEAR(count, 1000, 110);
}

// n = 4000: mean 25 with standard error 5 / sqrt(n) = 0.079, sd with 5 / sqrt(2 n) = 0.056; 4 standard errors
// (chance 1e-4, seed 1). The truncation at 1 cm lies 4.8 sd away.
TEST(Planting, DiametersAreNormal) {
  const auto planted = plant_trees(plot_with({{"pine", 4000, PlantingPattern::kRandom, 0, 25, 5}}), {});
  double sum = 0, squares = 0;
  for (const InventoryTree& tree : planted.trees) {
    sum += tree.dbh_cm;
    squares += tree.dbh_cm * tree.dbh_cm;
  }
  const double mean = sum / 4000, sd = std::sqrt(squares / 4000 - mean * mean);
  EXPECT_NEAR(mean, 25, 0.32);
  EXPECT_NEAR(sd, 5, 0.23);
}

TEST(Planting, NoDiameterUnderOneCentimetre) {
  const auto planted = plant_trees(plot_with({{"pine", 2000, PlantingPattern::kRandom, 0, 2, 20}}), {});
  for (const InventoryTree& tree : planted.trees) EXPECT_GE(tree.dbh_cm, 1.0);
}

// One in 3500 normal diameters lies 3.45 sd above the mean: 4000 of them round 310 with sd 200 hold one over
// 1000 cm (seed 1), for which the rule is to blame, not a tree.
TEST(Planting, ASpreadTooWideIsSaidByItsKey) {
  const ForestSpec spec = plot_with({{"pine", 4000, PlantingPattern::kRandom, 0, 310, 200}});
  test::expect_refusal([&] { plant_trees(spec, {}); }, ErrorKind::kInvalidInput,
                       "forest.planting[0].dbh_sd_cm", "gives a tree of");
}

TEST(Planting, SeedDecidesAllOfIt) {
  ForestSpec spec = plot_with({{"beech", 50, PlantingPattern::kPoissonDisc, 3, 25, 5}});
  const auto first = plant_trees(spec, {}), again = plant_trees(spec, {});
  spec.seed = 2;
  const auto other = plant_trees(spec, {});
  ASSERT_EQ(first.trees.size(), again.trees.size());
  for (std::size_t i = 0; i < first.trees.size(); ++i) {
    EXPECT_EQ(first.trees[i].x_m, again.trees[i].x_m);
    EXPECT_EQ(first.trees[i].dbh_cm, again.trees[i].dbh_cm);
  }
  EXPECT_NE(first.trees[0].x_m, other.trees[0].x_m);
  EXPECT_NE(first.trees[0].dbh_cm, other.trees[0].dbh_cm);
}

TEST(Planting, ImpossibleRulesAreRefused) {
  const PlantingRule good{"beech", 10, PlantingPattern::kPoissonDisc, 3, 25, 5};
  struct Case {
    const char* where;
    std::function<void(ForestSpec&)> spoil;
  };
  const double nan = std::nan("");
  const std::vector<Case> cases{
      {"plot_width_m", [](ForestSpec& s) { s.plot_width_m = 0; }},
      {"plot_depth_m", [&](ForestSpec& s) { s.plot_depth_m = nan; }},
      {"planting[1].species", [](ForestSpec& s) { s.planting[1].species = ""; }},
      {"planting[1].count", [](ForestSpec& s) { s.planting[1].count = 0; }},
      {"planting[1].spacing_m", [](ForestSpec& s) { s.planting[1].spacing_m = 0; }},
      {"planting[1].spacing_m", [&](ForestSpec& s) { s.planting[1].spacing_m = nan; }},
      {"planting[1].dbh_mean_cm", [](ForestSpec& s) { s.planting[1].dbh_mean_cm = -5; }},
      {"planting[1].dbh_mean_cm", [&](ForestSpec& s) { s.planting[1].dbh_mean_cm = nan; }},
      {"planting[1].dbh_sd_cm", [](ForestSpec& s) { s.planting[1].dbh_sd_cm = -1; }},
  };
  for (const Case& c : cases) {
    ForestSpec spec = plot_with({good, good});
    c.spoil(spec);
    SCOPED_TRACE(c.where);
    test::expect_refusal([&] { plant_trees(spec, {}); }, ErrorKind::kInvalidInput, c.where, "is");
  }
  ForestSpec spec = plot_with({good, good});
  spec.planting[0].count = spec.planting[1].count = 6'000'000;
  test::expect_refusal([&] { plant_trees(spec, {}); }, ErrorKind::kLimitExceeded, "planting", "too many");
}

TEST(Planting, StopsWhenAsked) {
  std::stop_source source;
  source.request_stop();
  const ForestSpec spec = plot_with({{"beech", 10, PlantingPattern::kRandom, 3, 25, 5}});
  try {
    plant_trees(spec, {source.get_token(), {}});
    FAIL() << "did not stop";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kCancelled);
  }
}

// The shipped inventory is what its own head says: these rules, rounded to centimetres and millimetres of
// diameter.
TEST(Planting, ShippedStandFollowsItsRule) {
  ForestSpec spec = plot_with({{"Fagus sylvatica", 110, PlantingPattern::kPoissonDisc, 2.5, 28, 9},
                               {"Picea abies", 80, PlantingPattern::kPoissonDisc, 2.2, 26, 7},
                               {"Pinus sylvestris", 50, PlantingPattern::kPoissonDisc, 2.2, 31, 6}},
                              60, 60);
  spec.seed = 2024;
  const auto planted = plant_trees(spec, {});
  const auto shipped = read_inventory(test::source_dir() / "configs/scenes/mixed_stand_trees.csv");
  ASSERT_EQ(planted.trees.size(), 240U);
  ASSERT_EQ(shipped.size(), 240U);
  for (std::size_t i = 0; i < 240; ++i) {
    EXPECT_EQ(shipped[i].id, planted.trees[i].id);
    EXPECT_EQ(shipped[i].species, planted.trees[i].species);
    EXPECT_NEAR(shipped[i].x_m, planted.trees[i].x_m, 0.0051);
    EXPECT_NEAR(shipped[i].y_m, planted.trees[i].y_m, 0.0051);
    EXPECT_NEAR(shipped[i].dbh_cm, planted.trees[i].dbh_cm, 0.051);
  }
}

}  // namespace
}  // namespace sunfleck
