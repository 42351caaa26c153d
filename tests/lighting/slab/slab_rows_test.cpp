// The vector code against its plain twins over decades of depth, and both ways it is compiled.
#include "lighting/slab/slab_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "lighting/depth/exp_pair.h"
#include "lighting/slab/compensation.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

constexpr std::size_t kPoints = 500;  // no multiple of a register
constexpr int kMedia = 100;

// Depths over 13 decades, one in twenty of them 0; seed fixed.
class Depths {
 public:
  std::vector<float> row(double lowest, double highest) {
    std::vector<float> values;
    for (std::size_t i = 0; i < kPoints; ++i) {
      const bool zero = random_.uniform() < 0.05;
      values.push_back(zero ? 0.0f : static_cast<float>(std::exp(random_.uniform(lowest, highest))));
    }
    return values;
  }
  double share() { return random_.uniform(); }
  // 0, 1 and all between.
  double with_ends() {
    const double v = random_.uniform(-0.2, 1.2);
    return std::min(1.0, std::max(0.0, v));
  }

 private:
  RandomStream random_{7, 0, RandomPurpose::kTestScene};
};

// expm1 in the library is right to an ulp; ours may be off by two (1.2e-7, 2.2e-16 each).
TEST(ExpPair, IsRightToTwoUnits) {
  for (double y = 1e-12; y < 80.0; y *= 1.01) {
    const auto d = exp_pair(y);
    EXPECT_NEAR(d.falling, std::exp(-y), 5e-16 * std::exp(-y));
    EXPECT_NEAR(d.risen, -std::expm1(-y), -5e-16 * std::expm1(-y));
    const auto low = static_cast<float>(y);
    const auto f = exp_pair(low);
    const double truth = std::exp(-static_cast<double>(low)), risen = -std::expm1(-static_cast<double>(low));
    EXPECT_NEAR(f.falling, truth, 2.4e-7 * truth);
    EXPECT_NEAR(f.risen, risen, 2.4e-7 * risen);
  }
  EXPECT_EQ(exp_pair(0.0f).falling, 1.0f);
  EXPECT_EQ(exp_pair(0.0f).risen, 0.0f);
  EXPECT_LT(exp_pair(1e30f).falling, 1e-37f);
  EXPECT_EQ(exp_pair(1e30f).risen, 1.0f);
}

class Rows : public testing::TestWithParam<RowCode> {};

// The bound of the header, and 4e-7 of min(1, before) where almost all light that is there has been there
// twice.
TEST_P(Rows, OfSppFollowTheClosedForm) {
  Depths random;
  double worst = 0.0;
  for (int k = 0; k < kMedia; ++k) {
    const std::vector<float> before = random.row(-20, 10), behind = random.row(-20, 10);
    const SlabMedium<double> medium{k % 5 == 0 ? random.with_ends() : std::exp(-20 * random.share()),
                                    random.with_ends(), random.with_ends()};
    std::vector<float> down(kPoints), up(kPoints);
    spp_row(before, behind, row_medium(medium), down, up, GetParam());
    for (std::size_t i = 0; i < kPoints; ++i) {
      const auto light = spp<double>(before[i], behind[i], medium);
      const double sum = light.down + light.up;
      const double allowed = 5e-5 * sum + 4e-7 * std::min(1.0, static_cast<double>(before[i])) + 1e-35;
      ASSERT_NEAR(down[i], light.down, allowed) << before[i] << " " << behind[i] << " " << medium.absorption;
      ASSERT_NEAR(up[i], light.up, allowed) << before[i] << " " << behind[i] << " " << medium.absorption;
      if (sum > 1e-3) worst = std::max(worst, std::abs(down[i] + up[i] - sum) / sum);
    }
  }
  std::printf("rows of spp: worst relative error of down + up %.1e (where above 1e-3)\n", worst);
}

TEST_P(Rows, OfSppHFollowTheClosedForm) {
  Depths random;
  for (int k = 0; k < kMedia; ++k) {
    const std::vector<float> before = random.row(-20, 10), behind = random.row(-20, 10);
    const HemisphereMedium medium{
        std::max(1e-8, k % 5 == 0 ? random.with_ends() : std::exp(-18 * random.share())), random.with_ends(),
        random.share(), random.with_ends(), k % 7 == 0 ? 1.0 : 0.1 + 1.9 * random.share()};
    std::vector<float> down(kPoints), up(kPoints);
    spp_h_row(before, behind, medium, down, up, GetParam());
    for (std::size_t i = 0; i < kPoints; ++i) {
      const auto light = spp_h(before[i], behind[i], medium);
      // Rounding of either form in thin slabs, where they scatter no light this way in first order.
      const double rounding = 1e-14 * std::min(1.0, static_cast<double>(before[i]) + behind[i]);
      const double allowed = 2e-7 * (light.down + light.up) + rounding;
      ASSERT_NEAR(down[i], light.down, allowed) << before[i] << " " << behind[i] << " " << medium.absorption;
      ASSERT_NEAR(up[i], light.up, allowed) << before[i] << " " << behind[i] << " " << medium.absorption;
    }
  }
}

TEST_P(Rows, OfShortfallsFollowTheClosedForm) {
  Depths random;
  const std::vector<double> cosines{1.0, -1.0, 0.0, 1e-9, -1e-9, 1.0 - 1e-12, 0.3, -0.3, 0.9, -0.9};
  for (int k = 0; k < kMedia; ++k) {
    const std::vector<float> before = random.row(-20, 10), behind = random.row(-20, 10),
                             boundary = random.row(-14, 6);
    const double cosine =
        k % 2 ? 2 * random.share() - 1 : cosines[static_cast<std::size_t>(k / 2) % cosines.size()];
    std::vector<float> sum(kPoints, 0.0f);
    add_shortfall_row(before, behind, boundary, cosine, sum, GetParam());
    for (std::size_t i = 0; i < kPoints; ++i)
      ASSERT_NEAR(sum[i], compensation_shortfall<double>(before[i], behind[i], boundary[i], cosine), 5e-6)
          << before[i] << " " << behind[i] << " " << boundary[i] << " " << cosine;
  }
}

INSTANTIATE_TEST_SUITE_P(Code, Rows, testing::Values(RowCode::kBest, RowCode::kPlainCode));

// Infinite depths are deep ones.
TEST(Rows, TakeInfiniteDepths) {
  const float inf = std::numeric_limits<float>::infinity();
  const std::vector<float> before{0.0f, inf, 1.0f, inf}, behind{inf, 0.0f, inf, inf};
  std::vector<float> down(4), up(4);
  spp_row(before, behind, row_medium({0.1, 0.5, 0.2}), down, up);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto light = spp<double>(before[i], behind[i], {0.1, 0.5, 0.2});
    EXPECT_NEAR(down[i], light.down, 5e-5);
    EXPECT_NEAR(up[i], light.up, 5e-5);
  }
}

}  // namespace
}  // namespace sunfleck
