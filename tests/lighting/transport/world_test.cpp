// The world grid and its trees on scenes whose answer is known, and what every answer of theirs keeps.
#include <gtest/gtest.h>

#include <cstring>

#include "lighting/base/summaries.h"
#include "lighting/transport/world_scene.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "tests/lighting/transport/world_stand.h"

namespace sunfleck::test {
namespace {

const Vec3 kSun(0.3, -0.5, 0.6);

struct Solved {
  WorldPrepared prepared;
  WorldLight world;
};
Solved solved(const Forest& forest, const OpticsTable& optics, const Illumination& light,
              const WorldOptions& options = {}) {
  Solved s{.prepared = prepare_world(forest, options, {}), .world = {}};
  s.world = world_light(forest, optics, light, options, s.prepared, {});
  return s;
}

Forest lone_tree(int leaves = 3000) { return stand({.side = 1, .leaves = leaves}); }
Forest small_stand(bool periodic) { return stand({.side = 3, .leaves = 800, .periodic = periodic}); }

// ---- known answers

TEST(WorldFurnace, EveryFaceOfEveryTreeIsLitByOne) {
  // Nothing absorbs under an even sky of 1: so is all light, in the world's cells and on the leaves, whatever
  // is own and whatever others'.
  const WorldOptions tight{.convergence = 1e-6, .max_iterations = 2000};
  for (const bool periodic : {false, true}) {
    Forest forest = small_stand(periodic);
    forest.prototypes[0].wood.push_back({{0, 0, 0}, {0, 0, 3}, 0.15f, 0.1f, 0});
    for (Material& m : forest.materials) m.bands = {{"B", 0.6, 0.4, 1.0}};
    const OpticsTable optics = band_optics(forest, {"B"}, 1.0);
    const Solved s = solved(forest, optics, skylight(1), tight);
    for (const float radiance : s.world.bands[0].radiance)
      ASSERT_NEAR(radiance * kPi, 1.0, 2e-3) << periodic;  // floats over hundreds of orders
    for (const TreeLight& tree : s.world.bands[0].trees) {
      ASSERT_NEAR(tree.absorbed_w, 0.0, 1e-4 * tree.leaf_area_m2);
      // Both faces get 1; of effective area, which is less where leaves hide in a cell, and more in crowns of
      // few large leaves, each of which shades by -ln(1 - q) instead of q.
      ASSERT_LT(tree.mean_irradiance_w_m2, 2.2);
      ASSERT_GT(tree.mean_irradiance_w_m2, 1.2);
    }
    for (const std::size_t i : {std::size_t{0}, std::size_t{4}}) {
      const LightMap tree = tree_light(forest, optics, s.world, i, tight, {});
      for (const ElementLight& e : tree.bands[0].elements) {
        ASSERT_NEAR(e.front.total(), 1.0, 2e-3) << periodic;
        ASSERT_NEAR(e.back.total(), 1.0, 2e-3) << periodic;
      }
    }
  }
}

TEST(LoneTree, ShadesItselfOnceAsOnItsOwnGrid) {
  // With nobody around, the tree in the world is the tree on the grid: own shade counted twice would cost
  // it 20 to 40 % of its light.
  for (const double sun : {0.0, 1000.0}) {
    const StandCase c = stand_case(lone_tree(), 0.3);
    Illumination light = c.light;
    light.bands.assign(3, {sun, 1000.0 - sun});
    const Solved s = solved(c.forest, c.optics, light);
    const LightMap tree = tree_light(c.forest, c.optics, s.world, 0, {}, {});
    const LightMap grid = grid_light_map(c.forest, c.optics, light, {}, {});
    for (std::size_t b = 0; b < 3; ++b) {
      const StandErrors e = stand_errors(c.forest, tree.bands[b], grid.bands[b]);
      EXPECT_NEAR(e.bias, 0.0, 0.02) << b << ' ' << sun;  // other cells, other ground cells
      EXPECT_LT(e.leaf_mean_absolute, 0.05) << b << ' ' << sun;
      EXPECT_NEAR(e.direct_bias, 0.0, 0.005) << b;
    }
  }
}

TEST(LoneTree, HasNoOthersAround) {
  const Forest forest = lone_tree();
  const OpticsTable optics = band_optics(forest, {"NIR"}, 0.0);
  const Solved s = solved(forest, optics, sunlight(kSun, 1000, 100));
  // The sun's way through the fine grid alone: exactly what the grid method marches in the same cells.
  const LightMap tree = tree_light(forest, optics, s.world, 0, {}, {});
  const double cell = std::stod(tree.provenance.settings.at(2).second);
  const LightMap grid = grid_light_map(forest, optics, sunlight(kSun, 1000, 100), {.cell_m = cell}, {});
  double mean = 0.0, true_mean = 0.0;
  for (std::size_t i = 0; i < tree.sunlit_fraction.size(); ++i) {
    mean += tree.sunlit_fraction[i];
    true_mean += grid.sunlit_fraction[i];
  }
  EXPECT_NEAR(mean / true_mean, 1.0, 0.02);  // the two grids start at other points: 1 % with 3000 leaves
}

TEST(Interlocked, TwoTreesInOnePlaceShadeEachOther) {
  Forest forest = lone_tree(2000);
  Instance other = forest.instances[0];
  other.yaw_rad += 1.0f;
  other.position_m.x += 0.3;
  forest.instances.push_back(other);
  const StandCase c = stand_case(std::move(forest));
  const Solved s = solved(c.forest, c.optics, c.light);
  const std::vector<BandLightMap> trees = all_trees(c, s.world, {});
  const LightMap grid = grid_light_map(c.forest, c.optics, c.light, {}, {});
  for (std::size_t b = 0; b < 3; ++b) {
    const StandErrors e = stand_errors(c.forest, trees[b], grid.bands[b]);
    EXPECT_NEAR(e.bias, 0.0, 0.05) << b;  // the other tree is a cell's mean instead of leaves
    EXPECT_NEAR(e.direct_bias, 0.0, 0.05) << b;
    EXPECT_LT(e.tree_worst, 0.06) << b;
  }
}

TEST(WorldBudget, ClosesInAPeriod) {
  for (const double sun : {0.0, 1000.0}) {
    const Forest forest = small_stand(true);
    const OpticsTable optics = band_optics(forest, {"PAR", "NIR"}, 0.2);
    Illumination light = sunlight(kSun, sun, 1000 - sun);
    light.bands.push_back(light.bands[0]);
    const Solved s = solved(forest, optics, light);
    for (const WorldBand& band : s.world.bands) {
      const EnergyBudget& budget = band.budget;
      ASSERT_TRUE(band.has_budget);
      EXPECT_GT(budget.absorbed_foliage_w, 0.1 * budget.incident_w);
      EXPECT_LT(std::abs(budget.residual_w), 0.03 * budget.incident_w) << band.band << ' ' << sun;
    }
  }
}

// ---- invariants

struct Answer {
  WorldLight world;
  LightMap tree;
};
Answer answer(const Forest& forest, const Illumination& light, const WorldOptions& options = {}) {
  const OpticsTable optics = band_optics(forest, {"NIR"}, 0.2);
  Answer a{.world = solved(forest, optics, light, options).world, .tree = {}};
  a.tree = tree_light(forest, optics, a.world, forest.instances.size() / 2, options, {});
  return a;
}

class WorldInvariants : public testing::TestWithParam<bool> {
 protected:
  const Forest forest = small_stand(GetParam());
};
INSTANTIATE_TEST_SUITE_P(OpenAndPeriodic, WorldInvariants, testing::Bool());

TEST_P(WorldInvariants, SameBytesForOneAndTwoThreads) {
  Answer one, two;
  with_threads(1, [&] { one = answer(forest, sunlight(kSun, 500, 100)); });
  with_threads(2, [&] { two = answer(forest, sunlight(kSun, 500, 100)); });
  EXPECT_EQ(one.world.bands[0].radiance, two.world.bands[0].radiance);
  for (std::size_t i = 0; i < one.world.bands[0].trees.size(); ++i)
    EXPECT_EQ(one.world.bands[0].trees[i].absorbed_w, two.world.bands[0].trees[i].absorbed_w);
  const auto& a = one.tree.bands[0].elements;
  EXPECT_EQ(std::memcmp(a.data(), two.tree.bands[0].elements.data(), a.size() * sizeof(ElementLight)), 0);
}

TEST_P(WorldInvariants, AdditiveInTheSourcesWithinConvergence) {
  const Answer both = answer(forest, sunlight(kSun, 500, 100)), sun = answer(forest, sunlight(kSun, 500, 0)),
               sky = answer(forest, sunlight(kSun, 0, 100));
  for (std::size_t i = 0; i < both.world.bands[0].trees.size(); ++i)
    EXPECT_NEAR(both.world.bands[0].trees[i].absorbed_w /
                    (sun.world.bands[0].trees[i].absorbed_w + sky.world.bands[0].trees[i].absorbed_w),
                1.0, 4e-3);
  EXPECT_NEAR(both.tree.bands[0].trees[0].absorbed_w /
                  (sun.tree.bands[0].trees[0].absorbed_w + sky.tree.bands[0].trees[0].absorbed_w),
              1.0, 6e-3);  // convergence 2e-3 of the world and of the tree
}

TEST_P(WorldInvariants, LinearInTheStrengths) {
  const Answer weak = answer(forest, sunlight(kSun, 5, 1)), strong = answer(forest, sunlight(kSun, 5e5, 1e5));
  for (std::size_t i = 0; i < weak.world.bands[0].trees.size(); ++i)
    EXPECT_NEAR(strong.world.bands[0].trees[i].absorbed_w / weak.world.bands[0].trees[i].absorbed_w, 1e5, 3);
  EXPECT_NEAR(strong.tree.bands[0].trees[0].absorbed_w / weak.tree.bands[0].trees[0].absorbed_w, 1e5, 3);
}

TEST_P(WorldInvariants, SameFarFromTheOrigin) {
  Forest there = forest;
  for (Instance& i : there.instances) i.position_m += Vec3(1e4, -2e4, 1e4);
  there.terrain.elevation_m += 1e4;
  if (there.period) there.period->origin_m += Vec2(1e4, -2e4);
  const Answer a = answer(forest, sunlight(kSun, 500, 100)), b = answer(there, sunlight(kSun, 500, 100));
  EXPECT_NEAR(a.tree.bands[0].trees[0].absorbed_w / b.tree.bands[0].trees[0].absorbed_w, 1.0, 1e-4);
}

TEST_P(WorldInvariants, SoundForAnySun) {
  for (const Vec3& to_sun : {Vec3(0, 0, 1), Vec3(1, 0, 1e-9), Vec3(1, 0, 0), Vec3(0.7, 0.7, 0.05),
                             Vec3(0, -1, 0.2), Vec3(0, 0, -1)}) {
    const Answer a = answer(forest, sunlight(to_sun, 500, 100), {.directions = 8});
    for (const float radiance : a.world.bands[0].radiance) ASSERT_TRUE(radiance >= 0.0f && radiance < 1e4f);
    for (const TreeLight& tree : a.world.bands[0].trees) ASSERT_TRUE(tree.absorbed_w > 0.0);
  }
}

TEST(WorldSlope, TreesOnAHillsideAreSound) {
  for (const bool periodic : {false, true}) {
    Forest forest = small_stand(periodic);
    forest.terrain = {.elevation_m = 3, .slope_rad = 0.4, .aspect_rad = 1.0};
    for (Instance& i : forest.instances)
      i.position_m.z = forest.terrain.height_at(i.position_m.x, i.position_m.y);
    const StandCase c = stand_case(std::move(forest));
    const Solved s = solved(c.forest, c.optics, c.light);
    const std::vector<BandLightMap> trees = all_trees(c, s.world, {});
    const LightMap grid = grid_light_map(c.forest, c.optics, c.light, {}, {});
    // 800 leaves: cells of the two grids hold a few leaves each and differ by some percent.
    for (std::size_t b = 0; b < 3; ++b)
      EXPECT_NEAR(stand_errors(c.forest, trees[b], grid.bands[b]).bias, 0.0, 0.10) << b << ' ' << periodic;
  }
}

// ---- what it refuses

template <class Call>
void expect_refused(ErrorKind kind, const std::string& where, const Call& call) {
  try {
    call();
    ADD_FAILURE() << where << " was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    EXPECT_NE(error.where().find(where), std::string::npos) << error.what();
    EXPECT_FALSE(error.remedy().empty());
  }
}

TEST(WorldBadInput, IsRefusedWithPlaceAndRemedy) {
  const Forest forest = small_stand(false);
  const auto prepare = [&](const WorldOptions& o) { return [&, o] { prepare_world(forest, o, {}); }; };
  expect_refused(ErrorKind::kInvalidInput, "world.directions", prepare({.directions = 9}));
  expect_refused(ErrorKind::kInvalidInput, "world.cell_m", prepare({.cell_m = -1}));
  expect_refused(ErrorKind::kInvalidInput, "world.cell_m", prepare({.cell_m = NAN}));
  expect_refused(ErrorKind::kInvalidInput, "world.memory_limit_bytes", prepare({.memory_limit_bytes = 1}));
  expect_refused(ErrorKind::kInvalidInput, "world.convergence", prepare({.convergence = 0}));
  expect_refused(ErrorKind::kInvalidInput, "world.max_iterations", prepare({.max_iterations = 0}));
  expect_refused(ErrorKind::kLimitExceeded, "world.cell_m",
                 prepare({.cell_m = 0.001, .memory_limit_bytes = 64 << 20}));
  expect_refused(ErrorKind::kInvalidInput, "forest", [] { prepare_world(Forest{}, {}, {}); });
  const OpticsTable optics = band_optics(forest, {"NIR"}, 0.2);
  const WorldLight world = solved(forest, optics, skylight(1)).world;
  expect_refused(ErrorKind::kInvalidInput, "instance", [&] { tree_light(forest, optics, world, 9, {}, {}); });
}

TEST(WorldCells, AreCoarserWhereTheyMustBe) {
  const Forest forest = small_stand(false);
  const WorldPrepared usual = prepare_world(forest, {}, {});
  const WorldPrepared little = prepare_world(forest, {.memory_limit_bytes = 1 << 20}, {});
  EXPECT_GT(little.scene->layout.mean_cell_m(), usual.scene->layout.mean_cell_m());
  EXPECT_NE(little.notes.at(0).find("memory limit"), std::string::npos);
  EXPECT_LE(little.scene->cells() * transport::world_bytes_per_cell(26), 1u << 20);
}

}  // namespace
}  // namespace sunfleck::test
