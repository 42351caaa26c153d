// Scenes made from a seed: as large, as dense and as random as they say.
#include "sim/forest/generated_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sunfleck {
namespace {

TEST(GeneratedCrown, HasTheStatedLeafAreaInsideItsRadius) {
  for (const CrownKind kind :
       {CrownKind::kSphere, CrownKind::kClumped, CrownKind::kCone, CrownKind::kShell}) {
    const Forest forest =
        generated_crown({.kind = kind, .leaves = 2000, .radius_m = 2, .crown_lai = 3, .seed = 5});
    validate(forest);
    EXPECT_NEAR(forest_leaf_area_m2(forest), 3 * kPi * 4, 1e-3);
    const double side_m = std::sqrt(3 * kPi * 4 / 2000);
    for (const FoliageElement& e : forest.prototypes[0].foliage)
      ASSERT_LE(glm::length(Vec3(e.centre_m) - Vec3(0, 0, 3)), 2 * std::sqrt(2.0) + side_m);
  }
}

TEST(GeneratedCrown, FillsTheBallEvenlyWithNormalsThatPointEverywhere) {
  constexpr int n = 20000;
  const Forest forest = generated_crown({.leaves = n, .seed = 11});
  int inner = 0;
  Vec3 mean_normal(0);
  double squares_z = 0;
  for (const FoliageElement& e : forest.prototypes[0].foliage) {
    inner += glm::length(Vec3(e.centre_m) - Vec3(0, 0, 1.5)) < 0.5;
    const Vec3 normal = element_normal(e);
    mean_normal += normal / static_cast<double>(n);
    squares_z += normal.z * normal.z / n;
  }
  // One eighth of the volume lies within half the radius. False alarms: 4 sigma, 1 in 16,000 for each check.
  EXPECT_NEAR(inner, n / 8.0, 4 * std::sqrt(n * 0.125 * 0.875));
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(mean_normal[axis], 0, 4 * std::sqrt(1.0 / 3 / n));
  EXPECT_NEAR(squares_z, 1.0 / 3, 4 * std::sqrt(4.0 / 45 / n));
}

TEST(GeneratedCrown, ClumpsAreDenserThanAnEvenBall) {
  // Pairs of consecutive leaves are independent; count neighbours of the first 200 leaves within 0.1 radius
  // instead.
  const auto close_pairs = [](CrownKind kind) {
    const Forest forest = generated_crown({.kind = kind, .leaves = 4000, .seed = 2});
    const auto& leaves = forest.prototypes[0].foliage;
    int pairs = 0;
    for (std::size_t i = 0; i < 200; ++i)
      for (const FoliageElement& other : leaves)
        pairs += glm::length(Vec3(leaves[i].centre_m) - Vec3(other.centre_m)) < 0.1;
    return pairs;
  };
  EXPECT_GT(close_pairs(CrownKind::kClumped), 3 * close_pairs(CrownKind::kSphere));
}

TEST(GeneratedCrown, IsTheSameForTheSameSeedOnly) {
  const auto hash = [](std::uint64_t seed) {
    return content_hash(generated_crown({.leaves = 100, .seed = seed}));
  };
  EXPECT_EQ(hash(1), hash(1));
  EXPECT_NE(hash(1), hash(2));
}

TEST(GeneratedLayer, HasTheStatedLai) {
  const Forest forest = generated_layer({.lai = 3, .cell_m = 2, .height_m = 1, .leaves = 5000, .seed = 1});
  EXPECT_NEAR(forest_leaf_area_m2(forest), 3 * 4, 1e-3);
  EXPECT_EQ(forest.period->size_m, Vec2(2, 2));
}

}  // namespace
}  // namespace sunfleck
