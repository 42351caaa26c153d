// What the grid method knows of its limits before any work, and what of its work is kept for the next answer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "lighting/transport/grid_limits.h"
#include "lighting/transport/grid_parts.h"
#include "lighting/transport/leaf_clumping.h"
#include "sim/base/error.h"
#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"
#include "tests/lighting/transport/grid_light.h"

namespace sunfleck::test {
namespace {

TEST(Suitability, TellsSizesBeforeAnyWork) {
  const Forest forest = generated_crown({.leaves = 4000, .crown_lai = 5});
  const GridSuitability s = grid_suitability(forest, {});
  EXPECT_TRUE(s.suitable());
  EXPECT_NEAR(s.leaf_side_m, std::sqrt(5 * kPi / 4000), 1e-6);
  const GridPrepared prepared = prepare_grid(forest, {}, {});
  // Known from the bounds, which hold the edges of leaves too: at most a cell more on each side.
  EXPECT_NEAR(s.cell_m, prepared.scene->layout.mean_cell_m(), 0.1 * s.cell_m);
  EXPECT_GE(s.cells, prepared.scene->layout.cell_count());
  EXPECT_LE(s.cells, 2 * prepared.scene->layout.cell_count());
  EXPECT_EQ(s.bytes, grid_bytes(s.cells, 4000, 26));
}

// 400 trees of 4000 leaves on a square.
Forest rows_of(const Forest& tree) {
  Forest forest = tree;
  forest.instances.clear();
  for (int i = 0; i < 400; ++i)
    forest.instances.push_back({.position_m = {2.5 * (i % 20), 2.5 * (i / 20), 0},
                                .prototype = {},
                                .yaw_rad = 0.0f,
                                .scale = 1.0f,
                                .tree = {}});
  return forest;
}

TEST(CellRule, IsThatOfTheTreeInEveryStand) {
  const Forest tree = generated_crown({.leaves = 4000, .crown_lai = 5});
  EXPECT_NEAR(grid_cell_size(rows_of(tree)), grid_cell_size(tree), 1e-12);
  EXPECT_NEAR(grid_cell_size(tree), 2.0 * std::sqrt(5 * kPi / 4000), 1e-6);  // clamped at 2 sides
}

TEST(CellRule, GivesTreesOfManyLeavesNoMoreCellsThanLeaves) {
  for (const int leaves : {3000, 30000, 300000}) {
    const Forest tree = generated_crown({.leaves = leaves, .crown_lai = 5});
    const Vec3 size = forest_bounds(tree).size();
    const double cell = grid_cell_size(tree), side = std::sqrt(5 * kPi / leaves);
    EXPECT_GE(cell, 2.0 * side * (1 - 1e-6)) << leaves;
    EXPECT_LE(size.x * size.y * size.z / (cell * cell * cell), 1.7 * leaves) << leaves;
    if (leaves == 300000) {
      EXPECT_NEAR(size.x * size.y * size.z / (cell * cell * cell), 0.65 * leaves, 1.0);
    }
  }
}

// Leaves evenly in a cube of 16 cells, in a level sheet of it, or in every eighth cell alone: 8, 4 and 1
// times the neighbours in cells twice as wide. Some 20 others share a leaf's wide cell: 20,000 leaves tell it
// to 1 %.
TEST(Clumping, IsOneForEvenLeavesTwoForSheetsAndEightForFullCells) {
  enum class Spread { kEven, kSheet, kClumps };
  const auto clumping = [](Spread spread) {
    Prototype prototype;
    RandomStream random(3, 0, RandomPurpose::kTestScene);
    for (int i = 0; i < 20000; ++i) {
      Vec3 at(random.uniform(0, 16), random.uniform(0, 16), random.uniform(0, 16));
      if (spread == Spread::kSheet) at.z = 0.5;
      if (spread == Spread::kClumps) at = 2.0 * glm::floor(0.5 * at) + 0.25;
      prototype.foliage.push_back(leaf_towards({0, 0, 1}, 0.01, at));
    }
    for (const double corner : {0.0, 15.75})  // of the box; the last is alone or in the last clump
      prototype.foliage.push_back(
          leaf_towards({0, 0, 1}, 0.01, Vec3(corner, corner, spread == Spread::kSheet ? 0 : corner)));
    return transport::leaf_clumping(prototype, 1.0);
  };
  EXPECT_NEAR(clumping(Spread::kEven), 1.0, 0.03);
  EXPECT_NEAR(clumping(Spread::kSheet), 2.0, 0.04);
  EXPECT_NEAR(clumping(Spread::kClumps), 8.0, 0.01);
}

TEST(Clumping, CannotBeToldFromAFewLeaves) {
  EXPECT_EQ(transport::leaf_clumping(Prototype{}, 1.0), 1.0);
  Prototype one;
  one.foliage.push_back(leaf_towards({0, 0, 1}));
  EXPECT_EQ(transport::leaf_clumping(one, 1.0), 1.0);
  for (int i = 1; i < 10; ++i) one.foliage.push_back(one.foliage[0]);  // 45 pairs in one place
  EXPECT_EQ(transport::leaf_clumping(one, 1.0), 1.0);
}

TEST(CellRule, RefinesClumpedCrowns) {
  for (const std::uint64_t seed : {5, 6, 7}) {
    const auto sides = [&](CrownKind kind) {
      const Forest forest = generated_crown({.kind = kind, .leaves = 40000, .crown_lai = 5, .seed = seed});
      return grid_suitability(forest, {}).cell_sides;
    };
    EXPECT_NEAR(sides(CrownKind::kClumped), 2.3, 0.1) << seed;
    EXPECT_NEAR(sides(CrownKind::kSphere), 3.1, 0.1) << seed;
  }
}

TEST(DirectionRule, NoLevelDirectionsInWideStandsAndPeriods) {
  const Forest tree = generated_crown({.leaves = 400});
  Forest periodic = tree;
  periodic.period = Period{{-1, -1}, {2, 2}};
  const auto level = [](const Forest& forest) {
    const transport::DirectionSet set = transport::directions_for(forest, 26);
    return std::ranges::count_if(set.to_source, [](const Vec3& w) { return std::abs(w.z) < 0.01; });
  };
  EXPECT_EQ(level(tree), 8);
  EXPECT_EQ(level(rows_of(tree)), 0);
  EXPECT_EQ(level(periodic), 0);
}

TEST(Suitability, NamesFewLeavesAndBadCells) {
  EXPECT_TRUE(grid_suitability(generated_crown({.leaves = 299}), {}).few_elements);
  EXPECT_FALSE(grid_suitability(generated_crown({.leaves = 299}), {}).suitable());
  EXPECT_FALSE(grid_suitability(generated_crown({.leaves = 300}), {}).few_elements);
  const Forest crown = generated_crown({.leaves = 1500, .crown_lai = 5});
  const double side = std::sqrt(5 * kPi / 1500);
  EXPECT_TRUE(grid_suitability(crown, {.cell_m = 1.49 * side}).small_cells);
  EXPECT_FALSE(grid_suitability(crown, {.cell_m = 1.51 * side}).small_cells);
  EXPECT_TRUE(grid_suitability(crown, {.cell_m = 4.1 * side}).coarse_cells);
  EXPECT_TRUE(grid_suitability(crown, {.cell_m = 4.1 * side}).suitable());
}

TEST(MemoryLimit, RefusesCellsAskedForThatDoNotFit) {
  const Forest forest = generated_crown({.leaves = 4000, .crown_lai = 5});
  for (const double cell_m : {0.05, 1e-4, 1e-30}) {
    GridOptions options{.cell_m = cell_m, .memory_limit_bytes = 8 << 20};
    const GridSuitability s = grid_suitability(forest, options);
    EXPECT_FALSE(s.fits);
    EXPECT_GT(s.bytes, options.memory_limit_bytes);
    try {
      prepare_grid(forest, options, {});
      ADD_FAILURE() << cell_m << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kLimitExceeded);
      EXPECT_EQ(error.where(), "grid.cell_m");
      EXPECT_NE(error.problem().find(std::to_string(s.bytes)), std::string::npos) << error.problem();
      EXPECT_NE(error.problem().find("8388608"), std::string::npos);
      EXPECT_NE(error.remedy().find("at least"), std::string::npos);
    }
    // The size it names fits, one 5 % smaller does not.
    options.cell_m = s.smallest_cell_m;
    EXPECT_NO_THROW(prepare_grid(forest, options, {})) << s.smallest_cell_m;
    options.cell_m *= 0.95;
    EXPECT_FALSE(grid_suitability(forest, options).fits);
  }
}

TEST(MemoryLimit, ChoosesLargerCellsByItself) {
  const Forest forest = generated_crown({.leaves = 4000, .crown_lai = 5});
  const GridOptions options{.memory_limit_bytes = 2 << 20};
  const GridSuitability s = grid_suitability(forest, options);
  EXPECT_TRUE(s.fits);
  EXPECT_LE(s.bytes, options.memory_limit_bytes);
  const GridPrepared prepared = prepare_grid(forest, options, {});
  EXPECT_LE(grid_bytes(prepared.scene->cells(), 4000, 26), options.memory_limit_bytes);
}

TEST(MemoryLimit, KeepsTheCellAskedForWhereItFits) {
  // Two leaves 10 m apart in cells of 5 cm: 8 million cells that nobody would choose.
  Forest forest = forest_of({leaf_towards({0, 0, 1}), leaf_towards({0, 0, 1}, 0.1, {10, 10, 10})});
  const GridOptions options{.directions = 8, .cell_m = 0.049, .memory_limit_bytes = 3ull << 30};
  EXPECT_NEAR(grid_suitability(forest, options).cell_m, 0.049, 1e-9);
}

void expect_same(const LightMap& a, const LightMap& b) {
  ASSERT_EQ(a.sunlit_fraction, b.sunlit_fraction);
  for (std::size_t k = 0; k < a.bands.size(); ++k) {
    const auto& x = a.bands[k].elements;
    const auto& y = b.bands[k].elements;
    ASSERT_EQ(std::memcmp(x.data(), y.data(), x.size() * sizeof(ElementLight)), 0);
  }
}

TEST(Prepared, AnswersAsIfMadeAnew) {
  const Forest forest = generated_crown({.leaves = 2000, .crown_lai = 4});
  const GridPrepared prepared = prepare_grid(forest, {}, {});
  GridSources sources;
  const OpticsTable nir = band_optics(forest, {"NIR"}, 0.2), both = band_optics(forest, {"PAR", "NIR"}, 0.3);
  Illumination light = sunlight({0.3, -0.5, 0.6}, 500, 100);
  for (const Vec3& to_sun : {Vec3(0.3, -0.5, 0.6), Vec3(1, 0, 0.1), Vec3(0, 0, -1)}) {
    light.to_sun = to_sun;
    sources = grid_sources(forest, light, prepared, sources, {});
    expect_same(grid_light_map(forest, nir, light, {}, prepared, sources, {}),
                grid_light_map(forest, nir, light, {}, {}));
  }
  light.bands = {{0, 100}, {500, 0}};
  light.to_sun = {0, 0, 1};
  light.sky = SkyModel::kStandardOvercast;
  sources = grid_sources(forest, light, prepared, sources, {});
  expect_same(grid_light_map(forest, both, light, {}, prepared, sources, {}),
              grid_light_map(forest, both, light, {}, {}));
}

TEST(Prepared, SourcesAreKeptWhileTheyHold) {
  const Forest forest = generated_crown({.leaves = 2000, .crown_lai = 4});
  const GridPrepared prepared = prepare_grid(forest, {}, {});
  Illumination light = sunlight({0.3, -0.5, 0.6}, 500, 100);
  const GridSources first = grid_sources(forest, light, prepared, {}, {});
  light.bands[0] = {900, 300};
  const GridSources stronger = grid_sources(forest, light, prepared, first, {});
  EXPECT_EQ(stronger.sun, first.sun);
  EXPECT_EQ(stronger.sky, first.sky);
  light.to_sun = {0, 0, 1};
  const GridSources moved = grid_sources(forest, light, prepared, first, {});
  EXPECT_NE(moved.sun, first.sun);
  EXPECT_EQ(moved.sky, first.sky);
  light.sky = SkyModel::kStandardOvercast;
  EXPECT_NE(grid_sources(forest, light, prepared, moved, {}).sky, first.sky);
  light.bands[0] = {0, 100};
  EXPECT_EQ(grid_sources(forest, light, prepared, moved, {}).sun, nullptr);
}

}  // namespace
}  // namespace sunfleck::test
