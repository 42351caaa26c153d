// Sets of directions integrate what they promise; sectors keep the light of the sky.
#include <gtest/gtest.h>

#include <cmath>

#include "lighting/transport/sky_sectors.h"

namespace sunfleck::transport {
namespace {

template <class Term>
double integral(const DirectionSet& set, const Term& term) {
  double sum = 0.0;
  for (std::size_t j = 0; j < set.count(); ++j) sum += set.solid_angle_sr[j] * term(set.to_source[j]);
  return sum;
}

struct Named {
  const char* name;
  DirectionSet set;
  std::size_t count;
};
std::vector<Named> all_sets() {
  const Vec3 tilted = glm::normalize(Vec3(0.2, -0.3, 1));
  return {{"cubic 8", cubic_directions(8), 8},
          {"cubic 14", cubic_directions(14), 14},
          {"cubic 26", cubic_directions(26), 26},
          {"layered 8", layered_directions(8, {0, 0, 1}), 8},
          {"layered 14", layered_directions(14, {0, 0, 1}), 16},
          {"layered 26", layered_directions(26, tilted), 26}};
}

TEST(DirectionSets, AreUnitOppositePairsThatFillTheSphere) {
  for (const auto& [name, set, count] : all_sets()) {
    ASSERT_EQ(set.count(), count) << name;
    EXPECT_NEAR(integral(set, [](const Vec3&) { return 1.0; }), 4 * kPi, 1e-12) << name;
    for (std::size_t j = 0; j < set.half(); ++j) {
      EXPECT_NEAR(glm::length(set.to_source[j]), 1.0, 1e-15);
      EXPECT_EQ(set.to_source[j], -set.to_source[j + set.half()]);
    }
  }
}

TEST(DirectionSets, CubicOnesIntegratePolynomials) {
  // Over the sphere: x^2 -> 4 pi / 3; x^4 -> 4 pi / 5 (14, 26); x^2 y^2 z^2 -> 4 pi / 105 (26).
  for (const int count : {8, 14, 26})
    EXPECT_NEAR(integral(cubic_directions(count), [](const Vec3& w) { return w.x * w.x; }), 4 * kPi / 3,
                1e-12);
  for (const int count : {14, 26})
    EXPECT_NEAR(integral(cubic_directions(count), [](const Vec3& w) { return std::pow(w.y, 4); }),
                4 * kPi / 5, 1e-12);
  EXPECT_NEAR(integral(cubic_directions(26), [](const Vec3& w) { return std::pow(w.x * w.y * w.z, 2); }),
              4 * kPi / 105, 1e-12);
}

TEST(DirectionSets, LayeredOnesGiveExactFluxAndNeverRunLevel) {
  const Vec3 pole = glm::normalize(Vec3(0.2, -0.3, 1));
  for (const int count : {8, 14, 26}) {
    const DirectionSet set = layered_directions(count, pole);
    EXPECT_NEAR(integral(set, [&](const Vec3& w) { return std::max(0.0, glm::dot(w, pole)); }), kPi, 1e-12);
    for (const Vec3& w : set.to_source) EXPECT_GT(std::abs(glm::dot(w, pole)), 0.15);
  }
}

TEST(SkySectors, OpenGroundGetsTheDiffuseIrradiance) {
  for (const SkyModel sky : {SkyModel::kUniform, SkyModel::kStandardOvercast}) {
    for (const auto& [name, set, count] : all_sets()) {
      const SkySectors sectors = sky_sectors(set, sky, {0, 0, 1});
      EXPECT_NEAR(sectors.open_ground_irradiance, 1.0, 3e-4) << name;  // midpoints of 64 cosines
      double on_ground = 0.0;
      for (std::size_t j = 0; j < count; ++j) {
        on_ground += sectors.ground_weight_sr[j] * sectors.sky_radiance[j];
        EXPECT_GE(sectors.ground_share[j], 0.0);
        EXPECT_LE(sectors.ground_share[j], 1.0);
      }
      EXPECT_NEAR(on_ground, sectors.open_ground_irradiance, 1e-12) << name;
    }
  }
}

TEST(SkySectors, LevelDirectionsSeeHalfSkyHalfGround) {
  const DirectionSet set = cubic_directions(26);
  const SkySectors sectors = sky_sectors(set, SkyModel::kUniform, {0, 0, 1});
  for (std::size_t j = 0; j < set.count(); ++j) {
    const double share = set.to_source[j].z == 0 ? 0.5 : set.to_source[j].z < 0 ? 1.0 : 0.0;
    EXPECT_NEAR(sectors.ground_share[j], share, 1e-12);
    EXPECT_NEAR(sectors.sky_radiance[j], (1 - share) / kPi, 1e-12);
  }
}

}  // namespace
}  // namespace sunfleck::transport
