// What the grid method knows of its limits before any work, and what of its work is kept for the next answer.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "lighting/transport/grid_limits.h"
#include "lighting/transport/grid_parts.h"
#include "sim/base/error.h"
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
