// Properties every closed form of the envelope method keeps, and sweeps over decades without a NaN.
#include "lighting/envelope/closed_forms.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sim/base/contract.h"
#include "sim/base/vec.h"

namespace sunfleck::envelope {
namespace {

TEST(MeanCosines, DifferByASixthOfTheCosine) {
  // M(x) - M(-x) = x: Avt - Avr = <M(N.l) (N.w)> = (1/2) <(N.l)(N.w)> = cos(alpha) / 6.
  for (double a = 0.0; a <= kPi; a += 0.01) {
    const auto pair = angle_pair(a);
    EXPECT_NEAR(mean_transmitting_cosines(pair) - mean_reflecting_cosines(pair), std::cos(a) / 6.0, 1e-15);
  }
}

TEST(MeanCosines, MirrorEachOther) {
  for (double a = 0.0; a <= kPi; a += 0.01) {
    const auto pair = angle_pair(a);
    const AnglePair<double> mirrored{pair.supplement_rad, pair.angle_rad};
    EXPECT_EQ(mean_transmitting_cosines(mirrored), mean_reflecting_cosines(pair));
  }
  EXPECT_EQ(mean_reflecting_cosines(angle_pair(0.0)), 0.0);
  EXPECT_NEAR(mean_transmitting_cosines(angle_pair(0.0)), 1.0 / 6.0, 1e-16);
}

TEST(LobeFunction, SeriesMeetsTheDirectForm) {
  const double below = std::nextafter(0.7, 0.0);
  EXPECT_NEAR(lobe_function(below), lobe_function(0.7), 1e-15);
  const float below_f = std::nextafter(0.7f, 0.0f);
  EXPECT_NEAR(lobe_function(below_f), lobe_function(0.7f), 1e-7);
  for (double x = 0.0; x <= kPi; x += 0.001) EXPECT_GE(lobe_function(x), 0.0);
}

TEST(ScatteringLobe, ConservesEnergy) {
  // Over the sphere, B / (3 pi^2) must turn all light a leaf meets into r + t: 2 pi int B sin(a) da / (3
  // pi^2). Midpoint rule, 20000 steps: error of order step^2 = 2.5e-8.
  const LeafSums<double> leaf{2 * 0.31, 2 * 0.22};
  constexpr int kSteps = 20000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double a = (i + 0.5) * kPi / kSteps;
    sum += scattering_lobe(leaf, angle_pair(a)) * std::sin(a) * kPi / kSteps;
  }
  EXPECT_NEAR(2 * kPi * sum / (3 * kPi * kPi), 0.31 + 0.22, 1e-7);
}

TEST(ScatteringDensity, IsLinear) {
  const auto pair = angle_pair(0.8);
  const LeafSums<double> leaf{0.3, 0.1}, more{0.6, 0.2};
  const double one = scattering_density(100.0, 8, leaf, pair);
  EXPECT_NEAR(scattering_density(300.0, 8, leaf, pair), 3 * one, 1e-14 * one);
  EXPECT_NEAR(scattering_density(100.0, 8, more, pair), 2 * one, 1e-14 * one);
  EXPECT_NEAR(scattering_density(100.0, 16, leaf, pair), 0.5 * one, 1e-14 * one);
  const double parts = scattering_density(100.0, 8, LeafSums<double>{0.3, 0.0}, pair) +
                       scattering_density(100.0, 8, LeafSums<double>{0.0, 0.1}, pair);
  EXPECT_NEAR(parts, one, 1e-14 * one);
}

TEST(InterpolationWeights, SumToOneAndNeverVanishForTheCube) {
  // Sum M for the cube corners lies between 2 sqrt(6) / 3 (edge-on) and 4 / sqrt(3) (along an axis).
  double least = 10, most = 0;
  for (int i = 0; i < 200; ++i) {
    for (int k = 0; k <= 100; ++k) {
      const Vec3 light = direction_from_azimuth_zenith(i * kPi / 100, k * kPi / 100);
      std::array<double, 8> weights;
      const double sum = interpolation_weights<double>(cube_directions<double>(), light, weights);
      double total = 0.0;
      for (const double w : weights) total += w;
      ASSERT_NEAR(total, 1.0, 1e-14);
      least = std::min(least, sum);
      most = std::max(most, sum);
    }
  }
  EXPECT_NEAR(least, 2 * std::sqrt(6.0) / 3, 1e-3);
  EXPECT_NEAR(most, 4 / std::sqrt(3.0), 1e-12);
}

TEST(InterpolationWeights, FallBackToTheClosestOfAOneSidedSet) {
  const std::vector<Vec3> down = {{0, 0, -1}, {0.6, 0, -0.8}};
  std::vector<double> weights(2);
  EXPECT_EQ(interpolation_weights<double>(down, Vec3(0, 0, 1), weights), 0.0);
  EXPECT_EQ(weights, (std::vector<double>{0.0, 1.0}));
}

TEST(InterpolationWeights, RefuseALightFromNowhere) {
  std::array<double, 8> weights;
  const auto& cube = cube_directions<double>();
  EXPECT_THROW(interpolation_weights<double>(cube, Vec3(0.0), weights), ContractViolation);
  EXPECT_THROW(interpolation_weights<double>(cube, Vec3(NAN, 0, 1), weights), ContractViolation);
}

TEST(CubeDirections, AreInTheOrderOfEq26) {
  const auto& w = cube_directions<double>();
  for (std::size_t j = 0; j < 8; ++j) {
    EXPECT_NEAR(glm::length(w[j]), 1.0, 1e-15);
    EXPECT_EQ(w[j], -w[7 - j]);
  }
  EXPECT_LT(w[0].x, 0);
  EXPECT_TRUE(w[1].x > 0 && w[1].y < 0 && w[1].z < 0);
  EXPECT_TRUE(w[2].x < 0 && w[2].y < 0 && w[2].z > 0);
  EXPECT_TRUE(w[3].x > 0 && w[3].y < 0 && w[3].z > 0);
}

// 0 and twelve decades.
std::vector<double> decades() {
  std::vector<double> values = {0.0, 1e-300};
  for (int e = -9; e <= 6; ++e)
    for (const double m : {1.0, 3.0}) values.push_back(m * std::pow(10.0, e));
  return values;
}
const double kApproaches[] = {-3.0, -1.0,    -2.0 / 3,    -1e-9, 0.0,        1e-12, 1e-6,
                              0.5,  2.0 / 3, 1.0 - 1e-12, 1.0,   1.0 + 1e-9, 2.5};

template <class Real>
void sweep_integral(double slack) {
  for (const double d0 : decades()) {
    for (const double c : kApproaches) {
      double before = 0.0;
      for (const double d : decades()) {
        const Real j = one_bounce_integral(static_cast<Real>(d0), static_cast<Real>(c), static_cast<Real>(d));
        ASSERT_TRUE(std::isfinite(j)) << d0 << " " << c << " " << d;
        ASSERT_GE(j, 0) << d0 << " " << c << " " << d;
        ASSERT_LE(j, 1 + slack) << d0 << " " << c << " " << d;
        ASSERT_GE(j, before * (1 - slack) - 1e-37) << "falls with D: " << d0 << " " << c << " " << d;
        before = j;
      }
    }
  }
}
TEST(OneBounceIntegral, StaysInBoundsOverDecadesInDouble) { sweep_integral<double>(1e-12); }
TEST(OneBounceIntegral, StaysInBoundsOverDecadesInFloat) { sweep_integral<float>(2e-4); }

TEST(OneBounceIntegral, NeverGrowsWithTheDepthToTheSun) {
  for (const double c : kApproaches) {
    for (const double d : decades()) {
      double before = 2.0;
      for (const double d0 : decades()) {
        const double j = one_bounce_integral(d0, c, d);
        ASSERT_LE(j, before * (1 + 1e-12) + 1e-300) << d0 << " " << c << " " << d;
        before = j;
      }
    }
  }
}

TEST(OneBounceIntegral, IsTheInterceptedShareForUnshadedLeaves) {
  for (const double d : decades()) {
    EXPECT_NEAR(one_bounce_integral(0.0, 0.0, d), -std::expm1(-d), 1e-15);
    EXPECT_NEAR(one_bounce_integral(0.0, 0.5, d), -std::expm1(-d), 1e-15);
  }
}

TEST(OneBounceIntegral, MatchesPlainQuadrature) {
  // Midpoint rule of the integrand itself with 1e5 steps, on both sides of and across the turn.
  for (const double d0 : {0.0, 0.3, 2.0, 9.0})
    for (const double c : {-1.0, -0.4, 0.0, 0.3, 1.0, 1.7})
      for (const double d : {0.01, 1.0, 6.0}) {
        constexpr int kSteps = 100000;
        double sum = 0.0;
        for (int i = 0; i < kSteps; ++i) {
          const double x = (i + 0.5) * d / kSteps;
          sum += std::exp(-std::max(0.0, d0 - c * x) - x) * d / kSteps;
        }
        EXPECT_NEAR(one_bounce_integral(d0, c, d), sum, 1e-9) << d0 << " " << c << " " << d;
      }
}

TEST(OneBounceIntegral, DoesNotOverflowWhereThePrintedFormDoes) {
  // exp(-2000) exp(+1000) phi: 0 times infinity when taken apart.
  const double printed = std::exp(-2000.0) * 1000.0 * mean_decay((1.0 - 2.0) * 1000.0);
  EXPECT_TRUE(std::isnan(printed));
  EXPECT_EQ(one_bounce_integral(2000.0, 2.0, 1000.0), 0.0);
}

TEST(AngleBetween, KeepsTinyAngles) {
  for (int e = -15; e <= -1; ++e) {
    const double t = std::pow(10.0, e);
    const Vec3 a(0, 0, 1), b(std::sin(t), 0, std::cos(t));
    EXPECT_NEAR(angle_between<double>(a, b).angle_rad, t, 1e-14 * t);
    EXPECT_NEAR(angle_between<double>(a, -b).supplement_rad, t, 1e-14 * t);
  }
}

}  // namespace
}  // namespace sunfleck::envelope
