// The refined form against quadrature of the slab solution along the line, 400 random lines; and the limits
// in which the answer is known on paper.
#include "lighting/slab/refined_slab.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "lighting/slab/leaf_scatter.h"
#include "sim/base/random.h"
#include "sim/base/vec.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

// 5-point Gauss on 600 pieces that grow with the fourth power of their number: 1e-11 or better for rates
// below 20.
double by_quadrature(double before, double behind, const SlabMedium<double>& m, const SlabLine& line,
                     const ScatterShares& shares) {
  constexpr std::array<double, 5> at{-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                     0.9061798459386640};
  constexpr std::array<double, 5> weight{0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                         0.4786286704993665, 0.2369268850561891};
  const bool towards = line.cosine > 0.0;
  const double slab = towards ? before : behind, length = std::min(slab, line.true_end / line.rate);
  double sum = 0.0;
  constexpr int kPieces = 600;
  const auto edge = [&](int i) { return length * std::pow(static_cast<double>(i) / kPieces, 4); };
  for (int i = 0; i < kPieces; ++i)
    for (std::size_t g = 0; g < 5; ++g) {
      const double half = 0.5 * (edge(i + 1) - edge(i)), t = edge(i) + half * (1.0 + at[g]);
      const auto light = spp(towards ? std::max(before - t, 0.0) : before + t,
                             towards ? behind + t : std::max(behind - t, 0.0), m);
      sum += weight[g] * half * std::exp(-line.rate * t) *
             (shares.from_down * light.down + shares.from_up * light.up + shares.from_beam * light.direct);
    }
  double ground = 0.0;
  if (!towards && line.meets_ground)
    ground =
        std::exp(-std::min(line.rate * slab, line.true_end)) * spp(before + behind, 0.0, m).up / (2 * kPi);
  return (1.0 - m.absorption) * line.rate * sum + ground;
}

TEST(RefinedSlab, IsTheIntegralOfTheSlabsLight) {
  RandomStream random(3, 0, RandomPurpose::kTestScene);
  const auto between = [&](double a, double b) { return random.uniform(a, b); };
  for (int k = 0; k < 400; ++k) {
    const double before = std::exp(between(-4, 2)), behind = k % 11 == 0 ? 0.0 : std::exp(between(-4, 2));
    const SlabMedium<double> m{std::exp(between(-6, 0)), between(0, 1), k % 2 ? 0.0 : between(0, 1)};
    const double cosine = (k % 2 ? 1 : -1) * between(0.05, 1);
    const SlabLine line{cosine, k % 4 < 2 ? 1.0 / std::abs(cosine) : between(0.3, 2.3),
                        k % 3 ? 1e300 : between(0, 3), true};
    const ScatterShares shares{between(0, 1), between(0, 1), between(0, 1)};
    const double truth = by_quadrature(before, behind, m, line, shares);
    ASSERT_NEAR(RefinedSlab(before, behind, m).radiance(line, shares), truth, 1e-9 * truth + 1e-18) << k;
  }
}

// Looking straight to the light through leaves that absorb all but a trace: one scattering, integral of e^-t
// e^-(tau - t) = tau e^-tau; the printed A.1 divides 0 by 0 here.
TEST(RefinedSlab, HoldsWhereTheBeamAndTheLineFadeAlike) {
  const double tau = 1.7, albedo = 1e-6;
  const RefinedSlab slab(tau, 5.0, {1.0 - albedo, 0.5, 0.0});
  const double expected = albedo / (4 * kPi) * tau * std::exp(-tau);
  EXPECT_NEAR(slab.radiance({1.0, 1.0, 1e300, true}, {1 / (4 * kPi), 1 / (4 * kPi), 1 / (4 * kPi)}), expected,
              1e-5 * expected);
}

// Nothing around the point: only the ground is left, and not even that where the line does not meet it.
TEST(RefinedSlab, SeesOnlyTheGroundWhereTheLineEndsAtOnce) {
  const SlabMedium<double> m{0.1, 0.5, 0.3};
  const RefinedSlab slab(1.0, 2.0, m);
  EXPECT_EQ(slab.radiance({0.5, 2.0, 0.0, true}, {1, 1, 1}), 0.0);
  EXPECT_EQ(slab.radiance({-0.5, 2.0, 0.0, false}, {1, 1, 1}), 0.0);
  EXPECT_NEAR(slab.radiance({-0.5, 2.0, 0.0, true}, {1, 1, 1}), spp(3.0, 0.0, m).up / (2 * kPi), 1e-15);
}

// Means over the normals of 6,000 random leaves (2,000 of them looked at: noise 1 / sqrt(2000) of a spread
// near 0.3, six times that allowed) against the closed forms for needles, which point everywhere alike.
TEST(LeafScatter, OfRandomLeavesIsTheClosedForm) {
  const Forest forest = generated_crown({CrownKind::kSphere, 6000, 1.0, 5.0, 3});
  Prototype needles = forest.prototypes[0];
  for (FoliageElement& e : needles.foliage) e.shape = ElementShape::kShoot;
  for (const double zenith : {0.0, 0.5, 1.2, 2.0, kPi}) {
    const Vec3 look(std::sin(zenith), 0, std::cos(zenith)), sun(0, 0, 1);
    const LeafScatter leaves = leaf_scatter(forest.prototypes[0], look, sun),
                      random = leaf_scatter(needles, look, sun);
    EXPECT_NEAR(leaves.projection, random.projection, 0.04);
    EXPECT_NEAR(leaves.towards, random.towards, 0.04);
    EXPECT_NEAR(leaves.lit, random.lit, 0.04);
    EXPECT_NEAR(leaves.unlit, random.unlit, 0.04);
  }
}

// Scattering loses nothing: over all directions, the shares weighted with G of each add up as the light does.
// 2,000 directions of a spiral.
TEST(LeafScatter, SharesSumToOne) {
  const Forest forest = generated_crown({CrownKind::kSphere, 500, 1.0, 5.0, 3});
  double down = 0, up = 0, weight = 0;
  constexpr int kCount = 2000;
  for (int i = 0; i < kCount; ++i) {
    const double z = 1 - (2.0 * i + 1) / kCount, r = std::sqrt(1 - z * z), a = 2.399963 * i;
    const LeafScatter s =
        leaf_scatter(forest.prototypes[0], {r * std::cos(a), r * std::sin(a), z}, {0, 0, 1});
    const ScatterShares shares = s.shares(0.4);
    down += s.projection * shares.from_down;
    up += s.projection * shares.from_up;
    weight += s.projection;
  }
  // Leaves receive a quarter of a hemisphere's fluence on each side and half on both: mean 1 / (4 pi) per sr.
  EXPECT_NEAR(down / weight * 4 * kPi, 1.0, 0.01);
  EXPECT_NEAR(up / weight * 4 * kPi, 1.0, 0.01);
}

}  // namespace
}  // namespace sunfleck
