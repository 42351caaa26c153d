// SPP-H as a method: leaf angles, where it is meant to be used, and its error against traced light there and
// elsewhere.
#include <gtest/gtest.h>

#include <cmath>

#include "lighting/slab/canopy_angles.h"
#include "lighting/slab/spp_suitability.h"
#include "lighting/trace/reference.h"
#include "tests/lighting/slab/estimator_scene.h"

namespace sunfleck {
namespace {

using namespace test;

// Randomly turned leaves: G = 1/2, <n_z^2> = 1/3, integral of mu / G = 1; at 60 degrees m = 1. 20,000 leaves,
// of which 4,000 or more are looked at: noise of 0.29 / sqrt(4000) = 0.5 %, three times that allowed.
TEST(CanopyAngles, OfRandomLeaves) {
  const CanopyAngles angles(generated_layer({3.0, 4.0, 1.0, 20000, 3}));
  EXPECT_NEAR(angles.mean_square_cosine(), 1.0 / 3.0, 0.015);
  EXPECT_NEAR(angles.diffuse_cosine(), 1.0, 0.015);
  for (const double mu : {0.0, 0.3, 0.7, 1.0}) EXPECT_NEAR(angles.leaf_projection(mu), 0.5, 0.0075);
  const HemisphereMedium m = angles.medium(0.5, 0.1, 0.6, 0.2);
  EXPECT_NEAR(m.diffuse_cosine, 1.0, 0.03);
  EXPECT_NEAR(m.beam_backscatter, 0.5 + 0.3 / 3, 0.01);
  EXPECT_NEAR(m.diffuse_backscatter, 0.5 + 0.3 / 3, 0.01);
}

// Flat leaves: G = mu, so diffuse light fades like the beam whatever its angle, m = 1, and both turn back 1/2
// + q/2.
TEST(CanopyAngles, OfFlatLeaves) {
  const CanopyAngles angles(forest_of({square_leaf({0, 0, 2}, {0.05, 0, 0}, {0, 0.05, 0})}));
  const HemisphereMedium m = angles.medium(0.6, 0.1, 0.8, 0.0);
  EXPECT_NEAR(angles.mean_square_cosine(), 1.0, 0.02);
  EXPECT_NEAR(m.diffuse_cosine, 1.0, 0.02);
  EXPECT_NEAR(m.beam_backscatter, 0.9, 0.01);
  EXPECT_NEAR(m.diffuse_backscatter, 0.9, 0.01);
}

// A slope of 50 degrees sees leaves that lie flat in the world under its own angle.
TEST(CanopyAngles, AreMeasuredAgainstTheGround) {
  Forest forest = forest_of({square_leaf({0, 0, 2}, {0.05, 0, 0}, {0, 0.05, 0})});
  forest.terrain.slope_rad = radians_from_degrees(50);
  const double cosine = std::cos(radians_from_degrees(50));
  EXPECT_NEAR(CanopyAngles(forest).mean_square_cosine(), cosine * cosine, 0.02);
}

Forest grid_of_trees(int side, double spacing_m, bool periodic, int leaves) {
  Forest forest = generated_crown({CrownKind::kSphere, leaves, 1.0, 4.0, 5});
  const Instance first = forest.instances[0];
  forest.instances.clear();
  for (int i = 0; i < side * side; ++i) {
    Instance tree = first;
    tree.position_m += Vec3(spacing_m * (i % side), spacing_m * (i / side), 0.0);
    tree.yaw_rad = 0.7f * static_cast<float>(i);
    tree.tree = TreeId{static_cast<std::uint32_t>(i)};
    forest.instances.push_back(tree);
  }
  if (periodic) forest.period = Period{{0, 0}, {spacing_m * side, spacing_m * side}};
  return forest;
}

// Cover of circles that do not overlap: pi / 4 of their square, times that over the spacing squared; the
// squares of the plan and the cells of the grid round it up by up to a quarter. A cube's open sides: 4 of 6.
TEST(SppHSuitability, MeasuresCoverAndSides) {
  const SppHSuitability lone = spp_h_suitability(grid_of_trees(1, 1.0, false, 3000));
  EXPECT_NEAR(lone.open_side_share, 4.0 / 6.0, 0.01);
  EXPECT_FALSE(lone.suitable());
  EXPECT_NE(lone.reason(), "");
  const SppHSuitability wide = spp_h_suitability(grid_of_trees(2, 4.0, true, 3000));
  EXPECT_NEAR(wide.crown_cover, kPi / 16, 0.25 * kPi / 16);
  EXPECT_EQ(wide.open_side_share, 0.0);
  EXPECT_FALSE(wide.suitable());
  const SppHSuitability closed = spp_h_suitability(grid_of_trees(2, 1.6, true, 3000));
  EXPECT_GT(closed.crown_cover, 0.95);
  EXPECT_TRUE(closed.suitable());
  EXPECT_EQ(closed.reason(), "");
}

TEST(SppHSuitability, OfNothing) {
  Forest nothing = forest_of({});
  EXPECT_FALSE(spp_h_suitability(nothing).suitable());
  nothing.instances.clear();
  EXPECT_FALSE(spp_h_suitability(nothing).suitable());
}

// The layer with every leaf laid flat.
Forest flat_layer() {
  Forest forest = generated_layer({4.0, 4.0, 2.0, 5000, 13});
  for (FoliageElement& e : forest.prototypes[0].foliage) {
    const float half = 0.5f * std::sqrt(e.area_m2);
    e.half_u_m = {half, 0, 0};
    e.half_v_m = {0, half, 0};
  }
  return forest;
}

struct Score {
  double bias, rms;
};
Score scattered_score(const LightMap& map, const LightMap& reference) {
  double sum = 0.0, difference = 0.0, squares = 0.0;
  const auto& a = map.bands[0].elements;
  const auto& b = reference.bands[0].elements;
  for (std::size_t e = 0; e < a.size(); ++e) {
    const double truth = b[e].front.scattered_w_m2 + b[e].back.scattered_w_m2;
    const double d = a[e].front.scattered_w_m2 + a[e].back.scattered_w_m2 - truth;
    sum += truth;
    difference += d;
    squares += d * d;
  }
  const double n = static_cast<double>(a.size());
  return {difference / sum, std::sqrt(squares / n) / (sum / n)};
}

LightMap traced(const Forest& forest, const OpticsTable& optics, const Illumination& light) {
  ReferenceOptions options;
  options.rays_per_face = 64;
  options.ground = forest.period.has_value();
  return reference_light_map(forest, optics, light, options, {});
}

bool says_outside(const LightMap& map) {
  for (const std::string& note : map.provenance.notes)
    if (note.starts_with("outside its range")) return true;
  return false;
}

// Albedo 0.9, sun at 45 degrees. A homogeneous slab and a closed canopy of crowns: the sheet has 9 % in slabs
// and 19 % (+3 %) in canopies, [SPP]'s cosine 32 and 33 % (-26 %); the bounds leave the noise of one small
// geometry and of the reference (4 %) on top. An isolated crown has no such slab: forced, it runs, is off,
// and says so.
TEST(SppHReference, ClosedCanopiesAndAnIsolatedCrown) {
  const Illumination light = light_of(sun_at(45), 1000, 0);
  struct Case {
    const char* name;
    Forest forest;
    double rms, bias;
  };
  for (const Case& c : {Case{"slab", generated_layer({4.0, 4.0, 2.0, 5000, 13}), 0.17, 0.06},
                        Case{"slab of flat leaves", flat_layer(), 0.17, 0.06},
                        Case{"closed crowns", grid_of_trees(2, 1.6, true, 1500), 0.22, 0.08}}) {
    const OpticsTable optics = optics_of(c.forest, 0.45, 0.45);
    const LightMap reference = traced(c.forest, optics, light);
    const LightMap h = estimate(c.forest, optics, light, SppVariant::kSppH);
    const Score good = scattered_score(h, reference),
                published = scattered_score(estimate(c.forest, optics, light, SppVariant::kSpp), reference);
    std::printf("%s: spp_h bias %+.1f %%, per leaf %.1f %%; spp %+.1f %%, %.1f %%\n", c.name, 100 * good.bias,
                100 * good.rms, 100 * published.bias, 100 * published.rms);
    EXPECT_LT(good.rms, c.rms);
    EXPECT_LT(std::abs(good.bias), c.bias);
    EXPECT_LT(good.rms, 0.75 * published.rms);
    EXPECT_FALSE(says_outside(h));
  }
  const Forest lone = generated_crown({CrownKind::kSphere, 3000, 1.0, 5.0, 21});
  const OpticsTable optics = optics_of(lone, 0.45, 0.45);
  const LightMap h = estimate(lone, optics, light, SppVariant::kSppH);
  const Score bad = scattered_score(h, traced(lone, optics, light));
  std::printf("isolated: spp_h bias %+.1f %%, per leaf %.1f %%\n", 100 * bad.bias, 100 * bad.rms);
  EXPECT_GT(bad.bias, 0.2);  // no light leaves through sides the model does not have
  EXPECT_TRUE(says_outside(h));
}

// The published forms and the corrected one of spp_marched, same light, on the isolated crown: the true
// boundary takes away what the slab beyond the crown would send (measured +22 and -9 %).
TEST(SppMarchedReference, IsolatedCrown) {
  const Illumination light = light_of(sun_at(45), 1000, 0);
  const Forest forest = generated_crown({CrownKind::kSphere, 3000, 1.0, 5.0, 21});
  const OpticsTable optics = optics_of(forest, 0.45, 0.45);
  const LightMap reference = traced(forest, optics, light);
  const auto score_of = [&](SppPhase phase, SppPaths paths) {
    SppOptions options;
    options.variant = SppVariant::kSppMarched;
    options.marched = {phase, paths, 0.0};
    const LightMap map = spp_light_map(forest, optics, light, options, {});
    EXPECT_EQ(map.provenance.method, "spp_marched");
    const Score s = scattered_score(map, reference);
    std::printf("%s, %s: bias %+.1f %%, per leaf %.1f %%\n",
                phase == SppPhase::kIsotropic ? "isotropic" : "leaf angles",
                paths == SppPaths::kSlab ? "slab" : "true boundary", 100 * s.bias, 100 * s.rms);
    return s;
  };
  const Score published = score_of(SppPhase::kIsotropic, SppPaths::kSlab);
  const Score corrected = score_of(SppPhase::kLeafAngles, SppPaths::kTrueBoundary);
  EXPECT_GT(published.bias, 0.1);
  EXPECT_LT(std::abs(corrected.bias), 0.15);
  EXPECT_LT(corrected.rms, 0.30);
  EXPECT_LT(corrected.rms, published.rms);
}

}  // namespace
}  // namespace sunfleck
