// The vectorised J against its plain twin, and its bounds.
#include "lighting/envelope/bounce_kernel.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "sim/base/random.h"

namespace sunfleck::envelope {
namespace {

// Absolute, where J <= 1: exp to the 7th order and five roundings of numbers below 1.
constexpr double kTolerance = 4e-6;

using Row = std::array<float, 16>;

// Depths from 1e-9 to 80, now and then 0 or the largest.
float any_depth(RandomStream& random) {
  const double choice = random.uniform(0, 1);
  if (choice < 0.1) return 0.0f;
  if (choice < 0.2) return 80.0f;
  return static_cast<float>(std::pow(10.0, random.uniform(-9, 1.9)));
}

float any_approach(RandomStream& random) {
  const double choice = random.uniform(0, 1);
  if (choice < 0.2) return 1.0f;
  if (choice < 0.3) return static_cast<float>(random.uniform(-100, 100));
  return static_cast<float>(random.uniform(-3, 3));
}

TEST(BounceRow, IsItsPlainTwin) {
  RandomStream random(11, 0, RandomPurpose::kTestScene);
  double worst = 0.0;
  for (int round = 0; round < 20000; ++round) {
    Row light, approach, fast, plain;
    for (float& d : light) d = any_depth(random);
    for (float& c : approach) c = any_approach(random);
    const float depth = any_depth(random);
    bounce_row(light, approach, depth, fast);
    bounce_row_plain(light, approach, depth, plain);
    for (std::size_t k = 0; k < fast.size(); ++k) {
      ASSERT_TRUE(std::isfinite(fast[k])) << light[k] << " " << approach[k] << " " << depth;
      ASSERT_GE(fast[k], 0.0f);
      ASSERT_LE(fast[k], 1.0 + kTolerance);
      ASSERT_NEAR(fast[k], plain[k], kTolerance) << light[k] << " " << approach[k] << " " << depth;
      worst = std::max<double>(worst, std::abs(fast[k] - plain[k]));
    }
  }
  std::cout << "worst difference " << worst << "\n";
}

TEST(BounceSectors, IsItsPlainTwin) {
  RandomStream random(12, 0, RandomPurpose::kTestScene);
  for (int round = 0; round < 20000; ++round) {
    Row depth, approach, fast, plain;
    for (float& d : depth) d = any_depth(random);
    for (float& c : approach) c = any_approach(random);
    const float light = any_depth(random);
    bounce_sectors(light, approach, depth, fast);
    bounce_sectors_plain(light, approach, depth, plain);
    for (std::size_t k = 0; k < fast.size(); ++k)
      ASSERT_NEAR(fast[k], plain[k], kTolerance) << light << " " << approach[k] << " " << depth[k];
  }
}

TEST(BounceRow, KeepsSmallLightOfThinCrownsRelatively) {
  // J of a thin sector is its depth: a crown of depth 1e-9 must not come out as 0.
  Row light{}, approach{}, result;
  for (const float depth : {1e-9f, 1e-6f, 1e-3f}) {
    bounce_row(light, approach, depth, result);
    EXPECT_NEAR(result[0] / -std::expm1(-depth), 1.0, 1e-6) << depth;
  }
}

TEST(RowProduct, AddsTripleProducts) {
  Row a, b, c;
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    a[k] = static_cast<float>(k);
    b[k] = 0.5f;
    c[k] = static_cast<float>(k % 3);
    sum += 0.5 * static_cast<double>(k) * static_cast<double>(k % 3);
  }
  EXPECT_FLOAT_EQ(row_product(a, b, c), static_cast<float>(sum));
}

}  // namespace
}  // namespace sunfleck::envelope
