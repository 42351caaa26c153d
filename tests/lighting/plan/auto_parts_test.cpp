// The parts of `auto` against numbers known on paper: intervals, error samples, corrections.
#include <gtest/gtest.h>

#include <cmath>

#include "lighting/plan/auto_correction.h"
#include "lighting/plan/auto_probe.h"
#include "sim/base/random.h"

namespace sunfleck::test {
namespace {

RandomStream stream(std::uint64_t seed) { return {seed, 0, RandomPurpose::kTestScene}; }

Figure mean_of(const std::vector<double>& values, std::span<const std::uint32_t> chosen) {
  const auto n = static_cast<double>(chosen.size());
  double mean = 0, squares = 0;
  for (const auto i : chosen) mean += values[i] / n;
  for (const auto i : chosen) squares += (values[i] - mean) * (values[i] - mean);
  return {mean, std::sqrt(squares / (n * (n - 1)))};
}

// Of 400 intervals for the mean of 60 values, 95 to 96 % hold it: 382 +- 4; exponential values (skewness 2,
// as errors of light) make a symmetric interval miss one in 14 or so. 400 trials: 3 sd = 13.
TEST(Interval, HoldsTheMeanNineteenTimesInTwenty) {
  for (const bool skewed : {false, true}) {
    int inside = 0;
    for (std::uint64_t trial = 1; trial <= 400; ++trial) {
      RandomStream random = stream(trial);
      std::vector<double> values(60);
      for (double& v : values) v = skewed ? -std::log(1.0 - random.uniform()) : random.normal();
      const Interval i = Resamples(60, trial).interval([&](auto chosen) { return mean_of(values, chosen); });
      const double truth = skewed ? 1.0 : 0.0;
      inside += i.low <= truth && truth <= i.high;
      EXPECT_LE(i.low, i.value);
      EXPECT_GE(i.high, i.value);
    }
    EXPECT_GE(inside, 367) << skewed;
    EXPECT_LE(inside, 395) << skewed;
  }
}

TEST(Interval, OfEqualValuesIsAPoint) {
  const Interval i = Resamples(16, 1).interval([&](auto) { return Figure{3.0, 0.0}; });
  EXPECT_EQ(i.low, 3.0);
  EXPECT_EQ(i.high, 3.0);
}

// Half of the probes 30 too high, half 10 too low, estimate's mean 110: difference 10, true mean 100, bias
// 10 %, RMS sqrt((900 + 100) / 2 - variance) / 100.
TEST(ErrorSample, GivesTheBiasAndTheRmsWithoutTheProbesNoise) {
  ErrorSample s;
  for (int i = 0; i < 100; ++i) {
    s.difference_w_m2.push_back(i % 2 == 0 ? 30.0 : -10.0);
    s.variance_w2_m4.push_back(100.0);
    s.area_m2.push_back(1.0);
  }
  s.mean_w_m2 = s.area_mean_w_m2 = 110.0;
  const PointError p = point_error(s);
  EXPECT_NEAR(p.bias.value, 0.10, 1e-12);
  EXPECT_NEAR(p.element_rms, 0.20, 1e-12);
  const ErrorBar bar = error_bar(s, Resamples(100, 1));
  EXPECT_EQ(bar.bias.value, p.bias.value);
  EXPECT_LT(bar.element_rms.low, 0.20);
  EXPECT_GT(bar.element_rms.high, 0.20);
  // Deviations of 20 over 100 probes: standard error 2 W m-2 on a mean of 100; with the bias of 10 in
  // squares.
  EXPECT_NEAR(bar.mean_standard_error_w_m2, std::hypot(10.0, 2.0), 0.5);
}

// Probes with area 3 are off by 4, those with area 1 by 0: the weighted mean is off by 3.
TEST(ErrorSample, WeighsTheBiasByArea) {
  ErrorSample s;
  for (int i = 0; i < 50; ++i) {
    s.difference_w_m2.push_back(i % 2 == 0 ? 4.0 : 0.0);
    s.variance_w2_m4.push_back(0.0);
    s.area_m2.push_back(i % 2 == 0 ? 3.0 : 1.0);
  }
  s.mean_w_m2 = 102.0;
  s.area_mean_w_m2 = 103.0;
  EXPECT_NEAR(point_error(s).bias.value, 0.03, 1e-12);
}

TEST(ErrorSample, OfDarknessIsZeroAndNotNaN) {
  ErrorSample s;
  s.difference_w_m2 = s.variance_w2_m4 = std::vector<double>(16, 0.0);
  s.area_m2 = std::vector<double>(16, 1.0);
  const ErrorBar bar = error_bar(s, Resamples(16, 1));
  EXPECT_EQ(bar.bias.high, 0.0);
  EXPECT_EQ(bar.element_rms.high, 0.0);
  EXPECT_EQ(bar.mean_standard_error_w_m2, 0.0);
}

struct Regression {
  std::vector<LightParts> estimate, truth;
  std::vector<double> weight;
};

// truth = 5 + 0.5 direct + 2 sky + 1.5 scattered, exactly.
Regression exact_parts() {
  Regression r;
  RandomStream random = stream(3);
  for (int i = 0; i < 40; ++i) {
    const LightParts e{random.uniform(0, 100), random.uniform(10, 50), random.uniform(5, 20)};
    r.estimate.push_back(e);
    r.truth.push_back({0.5 * e.direct_w_m2, 2 * e.sky_w_m2, 1.5 * e.scattered_w_m2 + 5});
    r.weight.push_back(random.uniform(0.5, 2));
  }
  return r;
}

TEST(Correction, FindsTheFactorsOfAnExactRelation) {
  const Regression r = exact_parts();
  const auto parts = fit(CorrectionForm::kParts, r.estimate, r.truth, r.weight);
  ASSERT_TRUE(parts);
  EXPECT_NEAR(parts->offset_w_m2, 5.0, 1e-9);
  EXPECT_NEAR(parts->direct, 0.5, 1e-10);
  EXPECT_NEAR(parts->sky, 2.0, 1e-10);
  EXPECT_NEAR(parts->scattered, 1.5, 1e-10);
  const auto diffuse = fit(CorrectionForm::kDiffuseParts, r.estimate, r.truth, r.weight);
  ASSERT_TRUE(diffuse);
  EXPECT_EQ(diffuse->direct, 1.0);
  EXPECT_NEAR(diffuse->sky, 2.0, 1e-10);
  const auto held_out = cross_validated(CorrectionForm::kParts, r.estimate, r.truth, r.weight);
  ASSERT_TRUE(held_out);
  for (std::size_t i = 0; i < r.truth.size(); ++i)
    EXPECT_NEAR((*held_out)[i].total(), r.truth[i].total(), 1e-9);
}

// truth = 3 + 0.8 diffuse + 12 sunlit fraction - 20 view of the closest leaves, exactly, and as exactly where
// the correction is applied to an element.
TEST(Correction, FindsWhatSunAndClosestLeavesChange) {
  Regression r;
  RandomStream random = stream(4);
  for (int i = 0; i < 40; ++i) {
    LightParts e{random.uniform(0, 100), random.uniform(40, 90), random.uniform(5, 20)};
    e.sunlit = random.uniform();
    e.close = random.uniform(0, 1.5);
    r.estimate.push_back(e);
    r.truth.push_back({e.direct_w_m2, 3 + 0.8 * e.diffuse() + 12 * e.sunlit - 20 * e.close, 0});
    r.weight.push_back(1.0);
  }
  const auto c = fit(CorrectionForm::kDiffuseBySunAndClose, r.estimate, r.truth, r.weight);
  ASSERT_TRUE(c);
  EXPECT_NEAR(c->offset_w_m2, 3.0, 1e-8);
  EXPECT_NEAR(c->sky, 0.8, 1e-10);
  EXPECT_NEAR(c->sunlit_w_m2, 12.0, 1e-8);
  EXPECT_NEAR(c->close_w_m2, -20.0, 1e-8);
  const ElementLight light{{10, 40, 5}, {0, 20, 5}, 0};
  EXPECT_NEAR(parts_of(corrected(light, 0.5, *c, 1.0)).total(), 10 + 3 + 0.8 * 70 + 6 - 20, 1e-4);
}

TEST(Correction, LeavesOutAPartThatIsNotThere) {
  Regression r = exact_parts();
  for (std::size_t i = 0; i < r.truth.size(); ++i) r.estimate[i].direct_w_m2 = r.truth[i].direct_w_m2 = 0.0;
  const auto c = fit(CorrectionForm::kParts, r.estimate, r.truth, r.weight);
  ASSERT_TRUE(c);
  EXPECT_EQ(c->direct, 0.0);
  EXPECT_NEAR(c->sky, 2.0, 1e-9);
}

TEST(Correction, RefusesNegativeFactors) {
  Regression r = exact_parts();
  for (std::size_t i = 0; i < r.truth.size(); ++i) r.truth[i] = {0, 0, 200.0 - r.estimate[i].total()};
  EXPECT_FALSE(fit(CorrectionForm::kTotal, r.estimate, r.truth, r.weight));
}

TEST(Correction, NeverGoesBelowZeroAndGivesFacesAndSumsAlike) {
  const ElementLight light{{10, 20, 5}, {0, 4, 1}, 0};
  for (const Correction& c : {Correction{-100, 1, 1, 1}, Correction{3, 0.5, 2, 1.5}, Correction{-2, 1, 0, 1},
                              Correction{4, 1, 0, 0}}) {
    const ElementLight after = corrected(light, 0, c);
    const LightParts sums = corrected(parts_of(light), c);
    for (const FaceLight& f : {after.front, after.back})
      for (const float x : {f.direct_w_m2, f.sky_w_m2, f.scattered_w_m2}) EXPECT_GE(x, 0.0f);
    EXPECT_NEAR(parts_of(after).direct_w_m2, sums.direct_w_m2, 1e-4);
    EXPECT_NEAR(parts_of(after).sky_w_m2, sums.sky_w_m2, 1e-4);
    EXPECT_NEAR(parts_of(after).scattered_w_m2, sums.scattered_w_m2, 1e-4);
  }
  const ElementLight dark = corrected(ElementLight{}, 0, {6, 1, 1, 1});
  EXPECT_EQ(dark.front.scattered_w_m2, 3.0f);
  EXPECT_EQ(dark.back.scattered_w_m2, 3.0f);
}

}  // namespace
}  // namespace sunfleck::test
