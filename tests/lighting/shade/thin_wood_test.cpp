// Thinned twigs keep their outline's area in the mean, nest, and leave thick wood alone.
#include "lighting/shade/thin_wood.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

std::vector<WoodSegment> twigs(int count, float radius_m) {
  return std::vector<WoodSegment>(static_cast<std::size_t>(count),
                                  {{0, 0, 0}, {0, 0, 0.1f}, 1.2f * radius_m, 0.8f * radius_m, 0});
}

double outline_m2(const std::vector<WoodSegment>& wood) {
  double sum = 0;
  for (const WoodSegment& s : wood)
    sum += static_cast<double>(glm::length(s.to_m - s.from_m)) * (s.radius_from_m + s.radius_to_m);
  return sum;
}

// 20,000 twigs of 2 mm, of which 1 in 10 stays: binomial, 5 standard deviations are 5 sqrt(9 / 20000).
TEST(ThinWood, KeepsItsOutline) {
  const std::vector<WoodSegment> wood = twigs(20000, 0.001f);
  const std::vector<WoodSegment> thinned = thin_wood(wood, 0.02, 3);
  EXPECT_NEAR(static_cast<double>(thinned.size()), 2000, 5 * std::sqrt(1800.0));
  EXPECT_NEAR(outline_m2(thinned) / outline_m2(wood), 1, 5 * std::sqrt(9 / 20000.0));
  for (const WoodSegment& s : thinned) {
    EXPECT_NEAR(s.radius_from_m + s.radius_to_m, 0.02, 1e-6);
    EXPECT_NEAR(s.radius_from_m / s.radius_to_m, 1.5, 1e-5);
  }
}

TEST(ThinWood, LeavesThickWoodAloneAndNests) {
  std::vector<WoodSegment> wood = twigs(1000, 0.001f);
  for (std::size_t i = 0; i < wood.size(); ++i) wood[i].material = static_cast<std::uint32_t>(i);
  wood[5].radius_from_m = wood[5].radius_to_m = 0.2f;
  EXPECT_EQ(thin_wood(wood, 0, 1).size(), wood.size());
  std::vector<bool> before(wood.size(), true);
  for (const double width_m : {0.004, 0.02, 0.1, 0.3}) {
    std::vector<bool> now(wood.size(), false);
    for (const WoodSegment& s : thin_wood(wood, width_m, 1)) {
      now[s.material] = true;
      EXPECT_TRUE(before[s.material]);
      if (s.material == 5) {
        EXPECT_EQ(s.radius_from_m, 0.2f);
      }
    }
    EXPECT_TRUE(now[5]);
    before = now;
  }
}

TEST(ThinWood, RefusesNonsenseAndDropsWhatHasNoWidth) {
  EXPECT_THROW(thin_wood(twigs(1, 0.1f), -1, 1), Error);
  EXPECT_THROW(thin_wood(twigs(1, 0.1f), std::nan(""), 1), Error);
  EXPECT_TRUE(thin_wood(twigs(10, 0), 0.01, 1).empty());
  EXPECT_TRUE(thin_wood({}, 0.01, 1).empty());
}

}  // namespace
}  // namespace sunfleck
