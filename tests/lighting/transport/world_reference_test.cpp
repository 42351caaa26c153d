// Trees of the world grid against traced light: stands of 16 trees of 1500 leaves, open and repeating. The
// reference's own scatter (48 rays per face) is inside the per-leaf figures. Seeds are fixed.
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
      EXPECT_LT(std::abs(e.bias), 0.09);  // crowns of 1500 leaves, a third of them clumped
      EXPECT_LT(e.leaf_mean_absolute, 0.20);
      EXPECT_LT(e.tree_rms, 0.08);
      EXPECT_LT(coarse.tree_rms, 0.12);
    }
  }
}

}  // namespace
}  // namespace sunfleck::test
