// Leaf angles and what foliage does to light: against the closed forms of uniformly turned leaves, by
// conservation, and for leaves that all lie flat.
#include "lighting/envelope/scattering.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lighting/envelope/closed_forms.h"
#include "sim/forest/generated_scenes.h"
#include "tests/lighting/envelope/scenes.h"

namespace sunfleck::envelope {
namespace {

const Vec3 kSun = glm::normalize(Vec3(0.45, 0.25, 0.86));

PrototypeAngles angles_of(const Forest& forest, EnvelopeAngles angles) {
  const BlockerField field(forest, {}, {});
  return measure_leaf_angles(forest, ForestIndex(forest), field, angles, {}).front();
}

Scattering scattering_of(const PrototypeAngles& angles, const SectorSet& set, const LeafOptics& leaf,
                         double bark = 0) {
  PrototypeMoments moments = prototype_moments(angles, set);
  for (const AngleSample& s : angles.samples) moments.sun.push_back(light_moments(s, set, kSun));
  return scattering(angles, moments, set, kSun, std::vector(angles.samples.size(), leaf), bark);
}

constexpr LeafOptics kLeaf{
    .reflectance_front = 0.5, .reflectance_back = 0.3, .transmittance_front = 0.1, .transmittance_back = 0.2};

// What a beam from w_k loses, G_k, comes back as a G_k, summed over all ways out.
void expect_conserving(const Scattering& s, const SectorSet& set, double albedo, double tolerance) {
  for (std::size_t k = 0; k < s.count; ++k) {
    double sent = 0.0;
    for (std::size_t j = 0; j < s.count; ++j)
      sent += set.solid_angle_sr[j] * s.projection[j] * s.turn[j * s.count + k] / set.solid_angle_sr[k];
    EXPECT_NEAR(sent / s.projection[k], albedo, tolerance) << k;
  }
  double from_sun = 0.0;
  for (std::size_t j = 0; j < s.count; ++j)
    from_sun += set.solid_angle_sr[j] * s.projection[j] * s.sun_turn[j];
  EXPECT_NEAR(from_sun / s.sun_projection, albedo, tolerance);
}

TEST(SphericalLeaves, AreTheClosedForms) {
  const Forest forest = generated_crown({.leaves = 2000});
  const PrototypeAngles angles = angles_of(forest, EnvelopeAngles::kSpherical);
  const SectorSet set = cubic_sectors(50);
  const Scattering s = scattering_of(angles, set, kLeaf);
  const LeafSums<double> sums{0.8, 0.3};
  for (std::size_t j = 0; j < set.count(); ++j) {
    EXPECT_NEAR(s.projection[j], 0.5, 1e-12);
    for (std::size_t k = 0; k < set.count(); ++k) {
      const double lobe = scattering_lobe(sums, angle_between<double>(set.to_source[j], set.to_source[k]));
      // Balancing on 50 directions moves it by what they miss of the kernel's integral, below 0.3 %.
      EXPECT_NEAR(s.turn[j * set.count() + k] / set.solid_angle_sr[k], lobe / (3 * kPi * kPi), 0.003)
          << j << " " << k;
    }
  }
}

TEST(Scattering, ConservesLightOnEverySet) {
  const Forest forest = generated_crown({.leaves = 2000});
  for (const EnvelopeAngles kind : {EnvelopeAngles::kSpherical, EnvelopeAngles::kMeasured})
    for (const int count : kSectorCounts) {
      const PrototypeAngles angles = angles_of(forest, kind);
      // Faces alike: the albedo is the same for every direction; rounding only.
      const LeafOptics even{0.4, 0.4, 0.25, 0.25};
      expect_conserving(scattering_of(angles, cubic_sectors(count), even), cubic_sectors(count), 0.65, 1e-12);
    }
}

TEST(MeasuredLeaves, OfARandomCrownAreNearlySpherical) {
  // 3000 normals: G scatters by 0.29 / sqrt(3000) = 0.005; four standard errors.
  const Forest forest = generated_crown({.leaves = 3000, .seed = 2});
  const SectorSet set = cubic_sectors(26);
  const Scattering s = scattering_of(angles_of(forest, EnvelopeAngles::kMeasured), set, kLeaf);
  for (const double projection : s.projection) EXPECT_NEAR(projection, 0.5, 0.022);
  EXPECT_NEAR(s.sun_projection, 0.5, 0.022);
  EXPECT_NEAR(s.albedo, 0.55, 0.01);
}

Forest flat_leaves() {
  std::vector<FoliageElement> leaves;
  for (int i = 0; i < 50; ++i) leaves.push_back(test::square_leaf({0.1 * i, 0, 1}, {0, 0, 1}, 0.05));
  return test::forest_of(leaves);
}

TEST(FlatLeaves, ProjectTheCosineAndThrowLightBackToItsSide) {
  const SectorSet set = cubic_sectors(14);
  const PrototypeAngles angles = angles_of(flat_leaves(), EnvelopeAngles::kMeasured);
  const Scattering mirror = scattering_of(angles, set, {0.6, 0.6, 0, 0});
  for (std::size_t j = 0; j < set.count(); ++j) {
    EXPECT_NEAR(mirror.projection[j], std::max(1e-6, std::abs(set.to_source[j].z)), 1e-7);
    // A leaf that only reflects, lit from above, shows its upper side: it is seen by looking down, w_j.z < 0.
    for (std::size_t k = 0; k < set.count(); ++k) {
      const double same_side = set.to_source[j].z * set.to_source[k].z;
      if (same_side > 0.1) {
        EXPECT_EQ(mirror.turn[j * set.count() + k], 0.0);
      } else if (same_side < -0.1) {
        EXPECT_GT(mirror.turn[j * set.count() + k], 0.0);
      }
    }
  }
}

TEST(Wood, TakesItsShareOfTheLight) {
  Forest forest = generated_crown({.leaves = 2000});
  forest.prototypes[0].wood = {
      {.from_m = {0, 0, 0}, .to_m = {0, 0, 2}, .radius_from_m = 0.5f, .radius_to_m = 0.5f}};
  const PrototypeAngles angles = angles_of(forest, EnvelopeAngles::kSpherical);
  // Side area 2 pi 0.5 2 = 2 pi, a quarter of it; leaves 5 pi, half of it: (pi / 2) / (pi / 2 + 2.5 pi).
  EXPECT_NEAR(angles.wood_share, 1.0 / 6, 1e-3);
  const SectorSet set = cubic_sectors(26);
  const LeafOptics even{0.4, 0.4, 0.2, 0.2};
  const Scattering s = scattering_of(angles, set, even, 0.3);
  EXPECT_NEAR(s.albedo, 0.6 * 5 / 6 + 0.3 / 6, 1e-3);
  expect_conserving(s, set, s.albedo, 1e-9);
}

TEST(Shoots, AbsorbWhatTheirNeedlesThrowAtEachOther) {
  Forest forest = generated_crown({.leaves = 500});
  for (FoliageElement& e : forest.prototypes[0].foliage) {
    e.shape = ElementShape::kShoot;
    e.half_u_m = glm::normalize(e.half_u_m) * 0.03f;
    e.half_v_m = glm::normalize(e.half_v_m) * 0.01f;
    e.area_m2 = 2.5e-3f;
  }
  const PrototypeAngles angles = angles_of(forest, EnvelopeAngles::kMeasured);
  const double e = angles.samples.front().escape;
  EXPECT_GT(e, 0.3);
  EXPECT_LT(e, 0.9);
  const Scattering s = scattering_of(angles, cubic_sectors(26), {0.45, 0.45, 0.45, 0.45});
  EXPECT_NEAR(s.albedo, 0.9 * e / (1 - 0.9 * (1 - e)), 1e-9);
  EXPECT_NEAR(s.projection[0], 0.5 * e, 1e-9);
}

TEST(Sampling, LooksAtEveryInstance) {
  // Leaves on edge in two instances turned by a quarter: seen along x half of them are face-on.
  std::vector<FoliageElement> leaves;
  for (int i = 0; i < 400; ++i) leaves.push_back(test::square_leaf({0.01 * i, 0, 1}, {1, 0, 0}, 0.05));
  Forest forest = test::forest_of(leaves);
  forest.instances.push_back(forest.instances[0]);
  forest.instances[1].yaw_rad = static_cast<float>(kPi / 2);
  forest.instances[1].position_m = {10, 0, 0};
  const AngleMoments moments =
      angle_moments(angles_of(forest, EnvelopeAngles::kMeasured).samples.front(), cubic_sectors(14));
  const SectorSet set = cubic_sectors(14);
  for (std::size_t j = 0; j < set.count(); ++j)
    if (set.to_source[j] == Vec3(1, 0, 0)) {
      EXPECT_NEAR(moments.facing[j] + moments.facing[set.opposite(j)], 0.5, 1e-6);
    }
}

}  // namespace
}  // namespace sunfleck::envelope
