// Sobol's points against their definition, and scrambled ones against what scrambling must keep.
#include "lighting/trace/low_discrepancy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace sunfleck::trace {
namespace {

TEST(LowDiscrepancy, FirstPointsAreThePublishedOnes) {
  // In the order without Gray code: 0, 1/2, 1/4, 3/4 and their partners.
  const std::array<CubePoint, 4> known = {{{0, 0, 0, 0, 0},
                                           {0.5, 0.5, 0.5, 0.5, 0.5},
                                           {0.25, 0.75, 0.75, 0.75, 0.25},
                                           {0.75, 0.25, 0.25, 0.25, 0.75}}};
  for (std::uint32_t i = 0; i < 4; ++i)
    for (std::size_t d = 0; d < kPointDimensions; ++d)
      EXPECT_EQ(sobol_point(i)[d] * 0x1p-32, known[i][d]) << i << " " << d;
}

// Any first 2^m points put one into every 2^-m of each axis, and one into every cell of the first two axes'
// 2^-a x 2^-(m-a), before and after scrambling.
TEST(LowDiscrepancy, EveryStratumHoldsOnePoint) {
  for (const std::uint64_t key : {1u, 2u, 77u}) {
    std::array<std::set<int>, kPointDimensions> strata;
    std::set<std::pair<int, int>> cells;
    for (std::uint32_t i = 0; i < 64; ++i) {
      const auto x = ScrambledPoints(key)(i);
      for (std::size_t d = 0; d < kPointDimensions; ++d) {
        ASSERT_GE(x[d], 0.0);
        ASSERT_LT(x[d], 1.0);
        strata[d].insert(static_cast<int>(64 * x[d]));
      }
      cells.insert({static_cast<int>(8 * x[0]), static_cast<int>(8 * x[1])});
    }
    for (const auto& s : strata) EXPECT_EQ(s.size(), 64u);
    EXPECT_EQ(cells.size(), 64u);
  }
}

// Over keys, every single point is even: mean 1/2 and variance 1/12, and differently keyed ones are
// uncorrelated (4000 keys: 4 standard errors, a false alarm in 1000 runs; the keys are fixed).
TEST(LowDiscrepancy, EveryPointAloneIsEven) {
  constexpr int kKeys = 4000;
  for (const std::uint32_t index : {0u, 1u, 13u})
    for (std::size_t d = 0; d < kPointDimensions; ++d) {
      double mean = 0, square = 0, product = 0;
      for (int k = 0; k < kKeys; ++k) {
        const double x = ScrambledPoints(static_cast<std::uint64_t>(k))(index)[d] - 0.5;
        const double y = ScrambledPoints(static_cast<std::uint64_t>(k) + 1)(index)[d] - 0.5;
        mean += x / kKeys, square += x * x / kKeys, product += x * y / kKeys;
      }
      EXPECT_NEAR(mean, 0, 4 * std::sqrt(1.0 / 12 / kKeys));
      EXPECT_NEAR(square, 1.0 / 12, 4 * std::sqrt(1.0 / 180 / kKeys));
      EXPECT_NEAR(product, 0, 4.0 / 12 / std::sqrt(kKeys));
    }
}

}  // namespace
}  // namespace sunfleck::trace
