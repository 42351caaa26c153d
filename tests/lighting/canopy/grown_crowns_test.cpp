// Measured crowns filled by grown trees, in the light: stand light against the traced reference.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/forest/forest_spec.h"
#include "tests/lighting/canopy/stand_scenes.h"
#include "tests/support/golden.h"

namespace sunfleck::test {
namespace {

Forest grown_stand() {
  ForestSpec spec;
  for (int i = 0; i < 3; ++i) {
    InventoryTree tree;
    tree.id = {static_cast<std::uint32_t>(i + 1)};
    tree.species = i == 1 ? "Picea abies" : "beech";
    tree.x_m = 2.0 + 3.0 * i, tree.y_m = 3.0 + 2.0 * (i % 2), tree.dbh_cm = 14 + 3 * i;
    tree.height_m = 11.0 + i, tree.crown_base_m = 2.0 + i, tree.widest_m = 6.0 + i;
    tree.radius_n_m = 2.5, tree.radius_e_m = 1.2, tree.radius_s_m = 1.8, tree.radius_w_m = 2.2;
    tree.leaf_area_density_per_m = 0.6;
    spec.inventory.push_back(tree);
  }
  spec.trees = TreeSource::kCrown;
  spec.filling = CrownFilling::kGrown;
  spec.elements_per_tree = 1500;
  spec.period = Period{{0, 0}, {10, 8}};
  return grow_forest(spec, SpeciesLibrary::load(source_dir() / "configs/species"), {}, nullptr);
}

TEST(GrownCrowns, LightAgreesWithTheReference) {
  const Forest forest = grown_stand();
  const OpticsTable optics(forest, {{"PAR"}, {0.1}, {}});
  const Vec3 sun = direction_from_azimuth_zenith(2.5, 0.7);
  StandLightRequest r;
  r.sky = stand_sky(sun_source(sun, 300.0), sky_source(SkyModel::kStandardOvercast, 8));
  for (double& v : r.sky.sky.strength.value) v *= 90.0;
  r.rays_per_cell = 60'000;
  r.tree_relative_error = 0;
  r.potential = false;
  const StandScene scene(forest, {});
  const StandLight light = stand_light(scene, optics, r, {});
  Illumination illumination = sunlight(sun, 300.0, 90.0);
  illumination.sky = SkyModel::kStandardOvercast;
  ReferenceOptions options;
  options.rays_per_face = 24;
  options.sun_rays_per_element = 24;
  const LightMap truth = reference_light_map(forest, optics, illumination, options, {});
  for (std::size_t t = 0; t < 3; ++t) {
    const TreeLight& tree = truth.bands[0].trees[t];
    // Both errors, and 1.5 % for light that is even over a leaf of the reference (elements of 4 dm2).
    const double error = std::hypot(4.0 * light.trees.absorbed[0].error_at(0, t),
                                    4.0 * tree.absorbed_standard_error_w, 0.015 * tree.absorbed_w);
    EXPECT_NEAR(light.trees.absorbed[0].at(0, t), tree.absorbed_w, error) << t;
    EXPECT_LT(error, 0.05 * tree.absorbed_w) << t;
  }
}

}  // namespace
}  // namespace sunfleck::test
