// The parts of the links method: point sets, directions in 32 bits, lobes.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "lighting/links/link_ends.h"
#include "lighting/links/link_lobes.h"
#include "lighting/links/owen_points.h"
#include "sim/base/random.h"

namespace sunfleck::links {
namespace {

TEST(OwenPoints, SobolsFirstPointsAreThePublishedOnes) {
  // Joe and Kuo's sequence, plain binary order: 1/2 everywhere, then (1/4, 3/4, 3/4, 3/4).
  EXPECT_EQ(sobol_bits(0), (std::array<std::uint32_t, 4>{0, 0, 0, 0}));
  for (const std::uint32_t b : sobol_bits(1)) EXPECT_EQ(b, 0x80000000u);
  EXPECT_EQ(sobol_bits(2),
            (std::array<std::uint32_t, 4>{0x40000000u, 0xC0000000u, 0xC0000000u, 0xC0000000u}));
}

// What scrambling must keep: each of 64 equal parts of every axis holds one of the first 64 points, and so
// does each of the 8 x 8 squares of the first two dimensions.
TEST(OwenPoints, EveryPartHoldsOnePoint) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    std::array<std::set<int>, 4> parts;
    std::set<int> squares;
    for (std::uint32_t i = 0; i < 64; ++i) {
      const Point4 p = owen_point(i, seed);
      for (std::size_t d = 0; d < 4; ++d) {
        EXPECT_GE(p[d], 0.0);
        EXPECT_LT(p[d], 1.0);
        parts[d].insert(static_cast<int>(64 * p[d]));
      }
      squares.insert(8 * static_cast<int>(8 * p[0]) + static_cast<int>(8 * p[1]));
    }
    for (const auto& axis : parts) EXPECT_EQ(axis.size(), 64u);
    EXPECT_EQ(squares.size(), 64u);
  }
}

// One point alone is even over the cube: its mean over 20,000 seeds is 1/2 within 5 standard errors
// (0.289 / sqrt(20,000) each; chance of a false alarm 4e-6), for an early and a late point.
TEST(OwenPoints, EveryPointAloneIsEven) {
  constexpr int kSeeds = 20000;
  for (const std::uint32_t index : {0u, 37u, 511u}) {
    Point4 mean{};
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed)
      for (std::size_t d = 0; d < 4; ++d) mean[d] += owen_point(index, mix_seed(seed, 7))[d] / kSeeds;
    for (const double m : mean) EXPECT_NEAR(m, 0.5, 5 * 0.289 / std::sqrt(kSeeds));
  }
}

TEST(LinkEnds, DirectionsComeBack) {
  RandomStream random(3, 0, RandomPurpose::kTestScene);
  double worst = 0.0;
  const auto check = [&](const Vec3& d) {
    const std::uint32_t end = sky_end(d);
    EXPECT_TRUE(is_sky(end));
    worst = std::max(worst, glm::length(sky_direction(end) - d));
  };
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) check(axis), check(-axis);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (glm::length(p) > 1e-3) check(glm::normalize(p));
  }
  EXPECT_LT(worst, 2e-4);  // steps of 6e-5 and 3e-5 on the octahedron, stretched up to threefold
}

// Shares of the hemisphere above the horizon: known, and all rays are dealt out.
TEST(LinkLobes, SharesAddUp) {
  for (const int links : {16, 17, 64, 256})
    for (const double z : {-1.0, -0.999999999, -0.7, -1e-9, 0.0, 0.3, 0.95, 1.0}) {
      const Lobes lobes = leaf_lobes(links, z);
      int all = 0;
      for (const LobeShare& l : lobes) {
        all += l.links;
        EXPECT_EQ(l.links == 0, l.weight == 0.0) << z;
        EXPECT_GE(l.cast, l.links);
        EXPECT_LT(l.cast, 1024);
      }
      EXPECT_EQ(all, 2 * links);
      EXPECT_DOUBLE_EQ(lobes[kFrontUp].weight + lobes[kFrontDown].weight, 1.0);
      EXPECT_DOUBLE_EQ(lobes[kBackUp].weight + lobes[kBackDown].weight, 1.0);
      EXPECT_NEAR(lobes[kFrontUp].weight, 0.5 * (1 + z), 1e-6);
    }
}

// The two parts of a hemisphere hold what they should, and together they are the whole: mean direction of a
// cosine-distributed ray is 2/3 of the normal. Midpoints of a 200 x 200 grid: good to 1e-3.
TEST(LinkLobes, PartsMakeUpTheCosineHemisphere) {
  constexpr int kGrid = 200;
  for (const Vec3& n :
       {Vec3(0, 0, 1), Vec3(0.6, 0, 0.8), Vec3(0, 1, 0), Vec3(0, -0.8, -0.6), Vec3(0, 0, -1)}) {
    Vec3 sum(0);
    for (const Part part : {Part::kUp, Part::kDown}) {
      const double weight = part == Part::kUp ? 0.5 * (1 + n.z) : 0.5 * (1 - n.z);
      if (weight == 0.0) continue;
      for (int i = 0; i < kGrid * kGrid; ++i) {
        const Vec3 d = cosine_direction(n, part, (i % kGrid + 0.5) / kGrid, (i / kGrid + 0.5) / kGrid);
        EXPECT_NEAR(glm::length(d), 1.0, 1e-12);
        EXPECT_GT(glm::dot(d, n), 0.0);
        EXPECT_TRUE(part == Part::kUp ? d.z > -1e-7 : d.z < 1e-7) << d.z;
        sum += weight / (kGrid * kGrid) * d;
      }
    }
    EXPECT_LT(glm::length(sum - 2.0 / 3.0 * n), 1e-3);
  }
}

}  // namespace
}  // namespace sunfleck::links
