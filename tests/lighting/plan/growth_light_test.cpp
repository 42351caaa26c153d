// The method `grid` as the light that trees grow by: against a layer known on paper, and against the quick
// approximation of growth in trees grown with both.
#include "lighting/plan/growth_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "sim/base/error.h"
#include "sim/base/random.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

const Species& beech() {
  static const Species species = load_species(test::source_dir() / "configs/species/fagus_sylvatica.toml");
  return species;
}
const Species& oak() {
  static const Species species = load_species(test::source_dir() / "configs/species/quercus_robur.toml");
  return species;
}

GrowthSite black_square(double side_m, double height_m) {
  GrowthSite site;
  site.room.include(Vec3(0, 0, 0));
  site.room.include(Vec3(side_m, side_m, height_m));
  site.period_m = Vec2(side_m, side_m);
  site.leaf_reflectance = site.leaf_transmittance = site.soil_albedo = 0;
  return site;
}

// Level black leaves, LAI 1.5 at random between 3 and 5 m: whatever its direction, exp(-1.5) = .223 of the
// light comes through. The cells of 0.16 m2 hold 24 leaves each, so that the LAI over a cell scatters by 20
// %; the mean of exp(-LAI) over 100 of them is 4 % above exp(-1.5) and known to 3 %: 10 % in all.
TEST(GrowthLightByGrid, BelowALayerOfLevelLeaves) {
  const GrowthSite site = black_square(4, 8);
  std::vector<LeafPlace> leaves;
  RandomStream random(7, 0, RandomPurpose::kPlanting);
  for (int i = 0; i < 2400; ++i) {
    const double x = random.uniform(0, 4), y = random.uniform(0, 4), z = random.uniform(3, 5);
    leaves.push_back({{x, y, z}, 0.01});
  }
  const BudLight light = growth_light_by_grid(site, {});
  EXPECT_EQ(light.at({1, 1, 1}), 1.0);  // before there are leaves
  light.new_year(leaves);
  double mean = 0;
  for (int i = 0; i < 64; ++i) mean += light.at({0.5 * (i % 8) + 0.2, 0.5 * (i / 8) + 0.2, 1.5}) / 64;
  EXPECT_NEAR(mean, std::exp(-1.5), 0.1 * std::exp(-1.5));
  EXPECT_GT(light.at({2, 2, 5.3}), 0.9);
  EXPECT_EQ(light.at({2, 2, 7}), 1.0);
  EXPECT_EQ(light.at({2, 2, 0}), 0.0);
  EXPECT_NEAR(light.at({0.3, 1, 4}), light.at({4.3, -3, 4}), 1e-6);  // a period further on
}

TEST(GrowthLightByGrid, FallsDownwards) {
  const GrowthSite site = black_square(4, 8);
  std::vector<LeafPlace> leaves;
  RandomStream random(8, 0, RandomPurpose::kPlanting);
  for (int i = 0; i < 3000; ++i) {
    const double x = random.uniform(0, 4), y = random.uniform(0, 4), z = random.uniform(2, 6);
    const double a = random.normal(), b = random.normal(), c = random.normal();
    leaves.push_back({{x, y, z}, 0.01, glm::normalize(Vec3(a, b, c))});
  }
  const BudLight light = growth_light_by_grid(site, {});
  light.new_year(leaves);
  double above = 2;
  for (const double z : {5.8, 4.8, 3.8, 2.8, 1.5}) {
    double mean = 0;
    for (int i = 0; i < 16; ++i) mean += light.at({1.0 * (i % 4) + 0.5, 1.0 * (i / 4) + 0.5, z}) / 16;
    EXPECT_LT(mean, above) << z;
    above = mean;
  }
}

struct Grown {
  TreeMeasures with_openness, with_grid;
};

Grown grown_with_both(const Species& species, std::optional<Vec2> period_m, int years) {
  const std::vector<Seedling> one{{&species, species.grammar_in_light, {0, 0}, 0.0, 1}};
  const GrowthSite site = site_of(one, period_m, years);
  GrowthOptions options;
  options.years = years;
  return {measure(grow_together(one, site, openness_light(site), options).trees.at(0)),
          measure(grow_together(one, site, growth_light_by_grid(site, {}), options).trees.at(0))};
}

void print(const char* name, const TreeMeasures& m) {
  std::printf(
      "  %-10s height %.2f m, crown base %.2f m, crown radius %.2f m, leaf area %.1f m2, dbh %.1f cm\n", name,
      m.height_m, m.crown_base_m, m.crown_radius_m, m.leaf_area_m2, 100 * m.dbh_m);
}

// Two ways to the same light: trees that differ in detail and agree in form. The bounds are what a forester
// would still call the same tree; the figures are printed.
TEST(GrowthLightByGrid, GrowsTreesLikeThoseOfTheApproximation) {
  for (const Species* species : {&beech(), &oak()})
    for (const bool in_stand : {false, true}) {
      const Grown tree =
          grown_with_both(*species, in_stand ? std::optional(Vec2(2.4, 2.4)) : std::nullopt, 13);
      std::printf("%s, %s, 13 years\n", species->latin.c_str(), in_stand ? "2.4 m apart" : "alone");
      print("openness", tree.with_openness);
      print("grid", tree.with_grid);
      EXPECT_NEAR(tree.with_grid.height_m, tree.with_openness.height_m, 0.2 * tree.with_openness.height_m);
      EXPECT_NEAR(tree.with_grid.crown_radius_m, tree.with_openness.crown_radius_m,
                  0.35 * tree.with_openness.crown_radius_m);
      EXPECT_GT(tree.with_grid.leaf_area_m2, 0.5 * tree.with_openness.leaf_area_m2);
      EXPECT_LT(tree.with_grid.leaf_area_m2, 2.0 * tree.with_openness.leaf_area_m2);
    }
}

// The stand sheds with this light too.
TEST(GrowthLightByGrid, NeighboursMakeAClearBole) {
  const Grown open = grown_with_both(beech(), std::nullopt, 13);
  const Grown stand = grown_with_both(beech(), Vec2(2.4, 2.4), 13);
  EXPECT_GT(stand.with_grid.crown_base_m, 1.5 * open.with_grid.crown_base_m);
  EXPECT_LT(stand.with_grid.leaf_area_m2, 0.7 * open.with_grid.leaf_area_m2);
}

TEST(GrowthLightByGrid, AnswersScenesAndStops) {
  ForestSpec spec;
  spec.trees = TreeSource::kLsystem;
  spec.inventory = parse_inventory("id_tree,species,x,y,dbh_cm\n1,fasy,0,0,1\n2,quro,1.5,0,1\n", "t.csv");
  spec.grow_in_light = GrowInLight{7, 0, GrowthLight::kGrid, 0.4};
  const SpeciesLibrary library = SpeciesLibrary::load(test::source_dir() / "configs/species");
  const Forest forest = grow_lit_forest(spec, library, {});
  EXPECT_EQ(forest.instances.size(), 2u);
  EXPECT_EQ(content_hash(grow_lit_forest(spec, library, {})), content_hash(forest));
  ForestSpec quick = spec;
  quick.grow_in_light->light = GrowthLight::kOpenness;
  EXPECT_NE(content_hash(grow_lit_forest(quick, library, {})), content_hash(forest));
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(grow_lit_forest(spec, library, {stop.get_token(), {}}), Error);
}

}  // namespace
}  // namespace sunfleck
