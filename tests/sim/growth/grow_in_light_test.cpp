// Trees whose form comes from light: alone, among equals, beside a wall.
#include "sim/growth/grow_in_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/base/error.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

struct Kind {
  const char *species, *grammar;
};
const Kind kKinds[] = {{"fagus_sylvatica", "fagus_sylvatica_in_light"},
                       {"quercus_robur", "quercus_robur_in_light"}};

GrownTree grown(const Kind& kind, const LightGridOptions& around, int years, std::uint64_t seed = 1) {
  const auto configs = test::source_dir() / "configs";
  const Species species = load_species(configs / "species" / (std::string(kind.species) + ".toml"));
  LightGrid grid(around);
  GrowthOptions options;
  options.years = years;
  options.seed = seed;
  return grow_in_light(species, configs / "grammars" / (std::string(kind.grammar) + ".lsys"), light_of(grid),
                       options);
}

LightGridOptions alone() {
  LightGridOptions around;
  around.half_width_m = 8;
  around.height_m = 16;
  return around;
}
LightGridOptions among_equals(double apart_m) {
  LightGridOptions around = alone();
  around.period_m = apart_m;
  return around;
}

// Largest distance of foliage from the stem to one side (x > 0 or x < 0).
double reach_m(const Prototype& tree, double side) {
  double reach = 0;
  for (const FoliageElement& e : tree.foliage)
    reach = std::max(reach, side * static_cast<double>(e.centre_m.x));
  return reach;
}

// Equal trees so near take each other's light from the side: the lower branches die and are shed, the crown
// is short and narrow. The stem goes up about as fast.
TEST(GrowInLight, NeighboursMakeAClearBole) {
  for (const Kind& kind : kKinds) {
    const TreeMeasures open = measure(grown(kind, alone(), 15).tree);
    const TreeMeasures stand = measure(grown(kind, among_equals(2.4), 15).tree);
    SCOPED_TRACE(kind.species);
    EXPECT_GT(stand.crown_base_m, 2 * open.crown_base_m);
    EXPECT_GT(stand.crown_base_m, 0.35 * stand.height_m);
    EXPECT_LT(open.crown_base_m, 0.3 * open.height_m);
    EXPECT_LT(stand.crown_radius_m, 0.7 * open.crown_radius_m);
    EXPECT_LT(stand.crown_radius_m, 0.65 * 2.4 + 0.6);  // room, and a last shoot beyond
    EXPECT_LT(stand.leaf_area_m2, 0.6 * open.leaf_area_m2);
    EXPECT_GT(stand.height_m, 0.8 * open.height_m);
    EXPECT_LT(stand.dbh_m, open.dbh_m);
  }
}

// Oak needs more light than beech: in the same stand it sheds more of its branches.
TEST(GrowInLight, OakShedsMoreThanBeech) {
  const TreeMeasures beech = measure(grown(kKinds[0], among_equals(2.4), 15).tree);
  const TreeMeasures oak = measure(grown(kKinds[1], among_equals(2.4), 15).tree);
  EXPECT_GT(1 - beech.crown_base_m / beech.height_m, 1 - oak.crown_base_m / oak.height_m);
}

TEST(GrowInLight, AWallMakesTheCrownLopsided) {
  for (const Kind& kind : kKinds) {
    LightGridOptions around = alone();
    Box wall;
    wall.include(Vec3(1, -50, 0));
    wall.include(Vec3(1.5, 50, 25));
    around.walls = {wall};
    const Prototype tree = grown(kind, around, 13).tree, free = grown(kind, alone(), 13).tree;
    SCOPED_TRACE(kind.species);
    EXPECT_LT(reach_m(tree, 1), 0.6 * reach_m(tree, -1));
    EXPECT_GT(reach_m(free, 1), 0.7 * reach_m(free, -1));
    EXPECT_LE(reach_m(tree, 1), 1.3);  // buds inside the wall get no light
  }
}

// Without light nothing lives; with little it lives and stays short.
TEST(GrowInLight, NoLightNoTree) {
  const Species beech = load_species(test::source_dir() / "configs/species/fagus_sylvatica.toml");
  const auto grammar = test::source_dir() / "configs/grammars/fagus_sylvatica_in_light.lsys";
  const auto under = [&](double light) {
    const BudLight constant{[](std::span<const LeafPlace>) {}, [light](const Vec3&) { return light; }};
    GrowthOptions options;
    options.years = 6;
    return measure(grow_in_light(beech, grammar, constant, options).tree);
  };
  EXPECT_EQ(under(0).leaf_area_m2, 0);
  EXPECT_GT(under(0.15).leaf_area_m2, 0);
  EXPECT_LT(under(0.15).height_m, 0.6 * under(1).height_m);
}

TEST(GrowInLight, SameSeedSameTree) {
  const Prototype a = grown(kKinds[0], alone(), 9).tree, b = grown(kKinds[0], alone(), 9).tree;
  const Prototype other = grown(kKinds[0], alone(), 9, 2).tree;
  ASSERT_EQ(a.foliage.size(), b.foliage.size());
  for (std::size_t i = 0; i < a.foliage.size(); ++i) EXPECT_EQ(a.foliage[i].centre_m, b.foliage[i].centre_m);
  EXPECT_FALSE(other.foliage.size() == a.foliage.size() &&
               other.foliage.front().centre_m == a.foliage.front().centre_m);
}

TEST(GrowInLight, StopsAtTheHeightAskedFor) {
  const Species beech = load_species(test::source_dir() / "configs/species/fagus_sylvatica.toml");
  LightGrid grid(alone());
  GrowthOptions options;
  options.years = 100;
  options.stop_height_m = 5;
  const GrownTree tree = grow_in_light(
      beech, test::source_dir() / "configs/grammars/fagus_sylvatica_in_light.lsys", light_of(grid), options);
  EXPECT_LT(tree.years, 20);
  EXPECT_NEAR(measure(tree.tree).height_m, 5.3, 0.4);  // a shoot is half a metre
}

TEST(GrowInLight, RefusesWhatCannotBe) {
  const Species beech = load_species(test::source_dir() / "configs/species/fagus_sylvatica.toml");
  const auto grammar = test::source_dir() / "configs/grammars/fagus_sylvatica_in_light.lsys";
  const auto with = [&](double light, GrowthOptions options) {
    const BudLight constant{[](std::span<const LeafPlace>) {}, [light](const Vec3&) { return light; }};
    return grow_in_light(beech, grammar, constant, options);
  };
  EXPECT_THROW(with(std::nan(""), {}), Error);
  EXPECT_THROW(with(1.5, {}), Error);
  GrowthOptions none;
  none.years = 0;
  EXPECT_THROW(with(1, none), Error);
  GrowthOptions full;
  full.years = 40;
  full.most_leaves = 2000;
  EXPECT_THROW(with(1, full), Error);
  EXPECT_THROW(grow_in_light(beech, "absent.lsys", {}, {}), Error);
}

}  // namespace
}  // namespace sunfleck
