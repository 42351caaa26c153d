// Trees that grow up together: one alone is the tree of grow_in_light(), neighbours take each other's light
// and room, and nothing depends on the number of threads.
#include "sim/growth/grow_together.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

const Species& species_named(const std::string& file) {
  static std::map<std::string, Species> known;
  const auto [entry, is_new] = known.try_emplace(file);
  if (is_new) entry->second = load_species(test::source_dir() / "configs/species" / (file + ".toml"));
  return entry->second;
}
const Species& beech() { return species_named("fagus_sylvatica"); }
const Species& oak() { return species_named("quercus_robur"); }

Seedling seedling(const Species& species, Vec2 place_m, std::uint64_t seed = 1) {
  return {&species, species.grammar_in_light, place_m, 0.0, seed};
}

GrownStand grown(const std::vector<Seedling>& seedlings, int years, std::optional<Vec2> period_m = {}) {
  const GrowthSite site = site_of(seedlings, period_m, years);
  GrowthOptions options;
  options.years = years;
  return grow_together(seedlings, site, openness_light(site), options);
}

bool same(const Prototype& a, const Prototype& b) {
  return a.foliage.size() == b.foliage.size() && a.wood.size() == b.wood.size() &&
         std::equal(a.foliage.begin(), a.foliage.end(), b.foliage.begin(), [](const auto& x, const auto& y) {
           return x.centre_m == y.centre_m && x.half_u_m == y.half_u_m && x.half_v_m == y.half_v_m;
         });
}

// Largest distance of foliage from the stem towards +x (side 1) or -x.
double reach_m(const Prototype& tree, double side) {
  double reach = 0;
  for (const FoliageElement& e : tree.foliage)
    reach = std::max(reach, side * static_cast<double>(e.centre_m.x));
  return reach;
}

TEST(GrowTogether, OneAloneIsTheTreeOfGrowInLight) {
  const GrownStand stand = grown({seedling(beech(), {0, 0})}, 11);
  LightGridOptions around;
  around.half_width_m = 8;
  around.height_m = 2 + 0.6 * 11;
  LightGrid grid(around);
  GrowthOptions options;
  options.years = 11;
  const GrownTree alone = grow_in_light(beech(), beech().grammar_in_light, light_of(grid), options);
  EXPECT_TRUE(same(stand.trees.at(0), alone.tree));
  EXPECT_GT(alone.tree.foliage.size(), 1000u);
}

// Two trees 2 m apart: each is narrower towards the other, and has fewer leaves than one alone. Buds end at
// .65 of the way to the other stem, 1.3 m; a last shoot of half a metre and its leaves reach beyond.
TEST(GrowTogether, TwoNeighboursTurnAwayFromEachOther) {
  for (const Species* species : {&beech(), &oak()}) {
    SCOPED_TRACE(species->latin);
    const GrownStand two = grown({seedling(*species, {0, 0}, 1), seedling(*species, {2, 0}, 2)}, 14);
    const GrownStand one = grown({seedling(*species, {0, 0}, 1)}, 14);
    const Prototype &west = two.trees[0], &east = two.trees[1];
    EXPECT_LT(reach_m(west, 1), 1.3 + 0.6);
    EXPECT_LT(reach_m(east, -1), 1.3 + 0.6);
    EXPECT_LT(reach_m(west, 1), 0.8 * reach_m(west, -1));
    EXPECT_LT(reach_m(east, -1), 0.8 * reach_m(east, 1));
    EXPECT_LT(measure(west).leaf_area_m2, 0.9 * measure(one.trees[0]).leaf_area_m2);
    EXPECT_GT(measure(west).leaf_area_m2, 0.3 * measure(one.trees[0]).leaf_area_m2);
    EXPECT_NEAR(measure(west).height_m, measure(one.trees[0]).height_m, 1.0);
  }
}

double mean_leaf_height_m(const Prototype& tree) {
  double sum = 0;
  for (const FoliageElement& e : tree.foliage) sum += static_cast<double>(e.centre_m.z);
  return sum / static_cast<double>(tree.foliage.size());
}

// Nine trees on a square of 1.8 m: the middle one has neighbours on all sides, those at the corners on two.
TEST(GrowTogether, TheMiddleOfAStandHasTheSmallestAndHighestCrown) {
  std::vector<Seedling> seedlings;
  for (int i = 0; i < 9; ++i)
    seedlings.push_back(seedling(beech(), {1.8 * (i % 3), 1.8 * (i / 3)}, static_cast<std::uint64_t>(i + 1)));
  const GrownStand stand = grown(seedlings, 14);
  double corners_m2 = 0, corners_height_m = 0;
  for (const std::size_t i : {0u, 2u, 6u, 8u}) {
    corners_m2 += measure(stand.trees[i]).leaf_area_m2 / 4;
    corners_height_m += mean_leaf_height_m(stand.trees[i]) / 4;
  }
  EXPECT_LT(measure(stand.trees[4]).leaf_area_m2, 0.8 * corners_m2);
  EXPECT_GT(mean_leaf_height_m(stand.trees[4]), corners_height_m + 0.2);
}

// A stand that repeats has no edge: every tree sheds its lower branches, as among equals in grow_in_light().
TEST(GrowTogether, AStandThatRepeatsHasNoEdge) {
  const GrownStand edge = grown({seedling(beech(), {0, 0})}, 14);
  const GrownStand inside = grown({seedling(beech(), {0, 0})}, 14, Vec2(2.4, 2.4));
  // Its lowest leaf is chance: 2.0 times as high with this seed.
  EXPECT_GT(measure(inside.trees[0]).crown_base_m, 1.5 * measure(edge.trees[0]).crown_base_m);
  EXPECT_LT(measure(inside.trees[0]).leaf_area_m2, 0.6 * measure(edge.trees[0]).leaf_area_m2);
}

TEST(GrowTogether, SameStandForAnyNumberOfThreads) {
  const std::vector<Seedling> seedlings{seedling(beech(), {0, 0}, 1), seedling(oak(), {2, 0.5}, 2),
                                        seedling(beech(), {0.7, 2}, 3)};
  std::optional<GrownStand> one, four;
  with_threads(1, [&] { one = grown(seedlings, 10); });
  with_threads(4, [&] { four = grown(seedlings, 10); });
  for (std::size_t i = 0; i < seedlings.size(); ++i) EXPECT_TRUE(same(one->trees[i], four->trees[i])) << i;
}

TEST(GrowTogether, StopsWhenAskedAndAtTheHeight) {
  const std::vector<Seedling> seedlings{seedling(beech(), {0, 0})};
  const GrowthSite site = site_of(seedlings, {}, 60);
  GrowthOptions options;
  options.years = 60;
  options.stop_height_m = 4;
  int reports = 0;
  const GrownStand stand = grow_together(seedlings, site, openness_light(site), options,
                                         {{}, [&](std::string_view, double) { ++reports; }});
  EXPECT_LT(stand.years, 20);
  EXPECT_EQ(reports, stand.years);
  EXPECT_NEAR(measure(stand.trees[0]).height_m, 4.3, 0.4);  // a shoot is half a metre
  std::stop_source stop;
  options.stop_height_m = 0;
  try {
    grow_together(seedlings, site, openness_light(site), options,
                  {stop.get_token(), [&](std::string_view, double) { stop.request_stop(); }});
    ADD_FAILURE() << "60 years went by";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kCancelled);
  }
}

TEST(GrowTogether, RefusesWhatCannotBe) {
  const std::vector<Seedling> seedlings{seedling(beech(), {0, 0})};
  const GrowthSite site = site_of(seedlings, {}, 5);
  EXPECT_THROW(grow_together({}, site, openness_light(site), {}), Error);
  EXPECT_THROW(grow_together(seedlings, site, {}, {}), Error);
  GrowthOptions none;
  none.years = 0;
  EXPECT_THROW(grow_together(seedlings, site, openness_light(site), none), Error);
  EXPECT_THROW(openness_light(site_of(seedlings, Vec2(2, 3), 5)), Error);  // no square
  GrowthOptions crowded;
  crowded.most_leaves_in_all = 1000;
  try {
    grow_together(seedlings, site, openness_light(site), crowded);
    ADD_FAILURE() << "more than 1,000 leaves grew";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kLimitExceeded);
  }
  GrowthSite fine = site;
  fine.cell_m = 0.01;
  EXPECT_THROW(openness_light(fine), Error);
}

}  // namespace
}  // namespace sunfleck
