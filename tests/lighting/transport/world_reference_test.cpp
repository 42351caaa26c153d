// Trees of the world grid, and the grid, against traced light: stands of 16 trees of 900 and 1500 leaves,
// open and repeating. The reference's own scatter (48 rays per face) is inside the per-leaf figures. Seeds
// are fixed.
#include <gtest/gtest.h>

#include <iostream>

#include "tests/lighting/transport/world_stand.h"

namespace sunfleck::test {
namespace {

TEST(AgainstRays, TreesInAStand) {
  for (const bool periodic : {false, true}) {
    const StandCase c = stand_case(stand({.side = 4, .leaves = 1500, .periodic = periodic}));
    const WorldOptions options;
    const WorldLight world =
        world_light(c.forest, c.optics, c.light, options, prepare_world(c.forest, options, {}), {});
    const std::vector<BandLightMap> trees = all_trees(c, world, options);
    ReferenceOptions rays;
    rays.rays_per_face = 48;
    rays.sun_rays_per_element = 16;
    const LightMap truth = reference_light_map(c.forest, c.optics, c.light, rays, {});
    for (std::size_t b = 0; b < trees.size(); ++b) {
      const StandErrors e = stand_errors(c.forest, trees[b], truth.bands[b]);
      StandErrors coarse;
      add_tree_errors(world.bands[b].trees, truth.bands[b].trees, coarse);
      std::cout << (periodic ? "periodic, " : "open, ") << world.bands[b].band << ": bias " << 100 * e.bias
                << " %, per leaf " << 100 * e.leaf_mean_absolute << " %, cell " << 100 * e.cell
                << " %, per tree " << 100 * e.tree_rms << " %, world alone per tree " << 100 * coarse.tree_rms
                << " %\n";
      // Crowns of 1500 leaves (0.18 m wide), a third of them clumped: clumps of 0.24 m, little more than a
      // leaf. Measured: bias 0.2 to 3.8 %, per tree 1.4 to 5.1 % and of the world alone to 6.5 %.
      EXPECT_LT(std::abs(e.bias), 0.05);
      EXPECT_LT(e.leaf_mean_absolute, 0.18);
      EXPECT_LT(e.cell, 0.065);
      EXPECT_LT(e.tree_rms, 0.065);
      EXPECT_LT(coarse.tree_rms, 0.08);
    }
  }
}

// Where the light of a wide open stand could go wrong, one by one: of leaves alone (no ground to give light
// back), of ground alone (leaves give nothing back), from sun and sky each. 16 rays per face of 14400 leaves:
// their mean is known to 0.3 %.
TEST(AgainstRays, PartsOfTheLightOfAWideStand) {
  Forest forest = stand({.side = 4, .leaves = 900, .kinds = {CrownKind::kSphere, CrownKind::kCone}});
  for (Material& m : forest.materials)
    m.bands = {{"sun leaves", 0.45, 0.45, 0},
               {"sky leaves", 0.45, 0.45, 0},
               {"sun ground", 0, 0, 0},
               {"sky ground", 0, 0, 0}};
  const OpticsTable optics(forest, {.bands = {"sun leaves", "sky leaves", "sun ground", "sky ground"},
                                    .soil_albedo = {0, 0, 0.6, 0.6},
                                    .overrides = {}});
  Illumination light;
  light.to_sun = glm::normalize(Vec3(0.45, 0.25, 0.86));
  light.bands = {{1000, 0}, {0, 1000}, {1000, 0}, {0, 1000}};
  ReferenceOptions rays;
  rays.rays_per_face = 16;
  rays.sun_rays_per_element = 16;
  const LightMap truth = reference_light_map(forest, optics, light, rays, {});
  const LightMap grid = grid_light_map(forest, optics, light, {}, {});
  const WorldLight world = world_light(forest, optics, light, {}, prepare_world(forest, {}, {}), {});
  const std::vector<BandLightMap> trees = all_trees({forest, optics, light}, world, {});
  for (std::size_t b = 0; b < grid.bands.size(); ++b) {
    for (const BandLightMap* own : {&grid.bands[b], &trees[b]}) {
      const StandErrors e = stand_errors(forest, *own, truth.bands[b]);
      std::cout << (own == &trees[b] ? "trees, " : "grid, ") << grid.bands[b].band << ": bias "
                << 100 * e.bias << " %, cell " << 100 * e.cell << " %, direct " << 100 * e.direct_bias
                << " %\n";
      // Level directions made the first of these 9 % too much. What stays: crowns of 900 leaves, 0.24 m wide,
      // are no quite random medium; light off the ground alone is little, and 16 rays know it to 10 % in a
      // cell.
      EXPECT_LT(std::abs(e.bias), 0.06) << grid.bands[b].band;
      EXPECT_LT(e.cell, b < 2 ? 0.08 : 0.15) << grid.bands[b].band;
    }
  }
}

}  // namespace
}  // namespace sunfleck::test
