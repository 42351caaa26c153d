// Closed forms against 120-digit answers (tests/golden/spp.json) and against identities known on paper.
#include "lighting/slab/spp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lighting/slab/compensation.h"
#include "lighting/slab/spp_h.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

// Relative difference, nothing below `floor` counts.
double error_of(double value, double truth, double floor) {
  const double difference = std::abs(value - truth);
  return difference <= floor ? 0.0 : difference / std::abs(truth);
}

double behind_of(const nlohmann::json& row) {
  const double thickness = row["W"], before = row["tau"];
  return thickness >= 1e12 ? kInfiniteOpticalDepth : thickness - before;
}

template <class Real>
double worst_slab_error(double floor) {
  const nlohmann::json vectors = test::golden("spp.json");
  double worst = 0.0;
  EXPECT_EQ(vectors["slab"].size(), 160u);
  for (const auto& row : vectors["slab"]) {
    const SlabMedium<Real> medium{row["alpha"].get<Real>(), row["R"].get<Real>(), row["rho"].get<Real>()};
    const SlabLight<Real> light = spp(row["tau"].get<Real>(), static_cast<Real>(behind_of(row)), medium);
    const double error =
        std::max({error_of(light.direct, row["direct"], floor), error_of(light.down, row["down"], floor),
                  error_of(light.up, row["up"], floor)});
    if (error > worst) worst = error;
  }
  return worst;
}

TEST(Spp, MeetsTheVectorsInDouble) {
  const double worst = worst_slab_error<double>(1e-30);
  RecordProperty("worst", std::to_string(worst));
  std::printf("slab double: worst relative error %.2e\n", worst);
  EXPECT_LT(worst, 5e-14);
}

TEST(Spp, MeetsTheVectorsInFloat) {
  const double worst = worst_slab_error<float>(1e-30);
  std::printf("slab float: worst relative error %.2e\n", worst);
  EXPECT_LT(worst, 5e-5);
}

TEST(SppH, MeetsTheVectors) {
  const nlohmann::json vectors = test::golden("spp.json");
  double worst = 0.0;
  ASSERT_EQ(vectors["slabH"].size(), 70u);
  for (const auto& row : vectors["slabH"]) {
    const HemisphereMedium medium{row["alpha"], row["R0"], row["Rd"], row["rho"], row["m"]};
    const SlabLight<double> light = spp_h(row["tau"], behind_of(row), medium);
    worst = std::max({worst, error_of(light.direct, row["direct"], 1e-30),
                      error_of(light.down, row["down"], 1e-30), error_of(light.up, row["up"], 1e-30)});
  }
  std::printf("slabH double: worst relative error %.2e\n", worst);
  EXPECT_LT(worst, 1e-11);
}

template <class Real>
double worst_shortfall_error() {
  const nlohmann::json vectors = test::golden("spp.json");
  double worst = 0.0;
  EXPECT_EQ(vectors["gs"].size(), 70u);
  for (const auto& row : vectors["gs"]) {
    const double behind = row["W"].get<double>() - row["z0"].get<double>();
    const Real value = compensation_shortfall(row["z0"].get<Real>(), static_cast<Real>(behind),
                                              row["n"].get<Real>(), row["c"].get<Real>());
    worst = std::max(worst, std::abs(static_cast<double>(value) - row["gs"].get<double>()));
  }
  return worst;
}

TEST(Compensation, MeetsTheVectors) {
  const double in_double = worst_shortfall_error<double>(), in_float = worst_shortfall_error<float>();
  std::printf("gs: worst absolute error %.2e (double), %.2e (float)\n", in_double, in_float);
  EXPECT_LT(in_double, 1e-14);
  EXPECT_LT(in_float, 5e-6);
}

// A slab of constant thickness has boundary depth before / c towards the light and behind / |c| away from it:
// nothing is missing, G = 1. With no medium around the point all is missing, G = 0.
TEST(Compensation, IsOneInASlabAndZeroInTheOpen) {
  const std::vector<double> cosines{1.0, 0.7, 0.2, -0.2, -0.7, -1.0};
  const double before = 1.5, behind = 2.5;
  std::vector<float> slab, open(cosines.size(), 0.0f);
  for (const double c : cosines)
    slab.push_back(std::nextafter(static_cast<float>((c > 0 ? before : behind) / std::abs(c)), 1e9f));
  EXPECT_NEAR(compensation(before, behind, slab, cosines), 1.0, 1e-12);
  EXPECT_NEAR(compensation(before, behind, open, cosines), 0.0, 1e-12);
}

// Nothing is absorbed (alpha = 0) and the ground is black: what enters leaves at one of the sides,
// up(0) + direct(W) + down(W) = 1.
TEST(Spp, LosesNoLightWithoutAbsorption) {
  for (const double thickness : {1e-9, 1e-3, 1.0, 30.0, 1e4, 1e6})
    for (const double backscatter : {0.0, 1e-6, 0.3, 0.5, 1.0}) {
      const SlabMedium<double> medium{0.0, backscatter, 0.0};
      const SlabLight<double> top = spp(0.0, thickness, medium), bottom = spp(thickness, 0.0, medium);
      EXPECT_NEAR(top.up + bottom.direct + bottom.down, 1.0, 1e-13) << thickness << " " << backscatter;
    }
}

// Leaf albedo 0: Beer's law and nothing else.
TEST(Spp, IsBeersLawForBlackLeaves) {
  for (const double depth : {0.0, 1e-9, 0.5, 20.0}) {
    const SlabLight<double> light = spp(depth, 3.0, SlabMedium<double>{1.0, 0.5, 0.0});
    EXPECT_DOUBLE_EQ(light.direct, std::exp(-depth));
    EXPECT_EQ(light.down, 0.0);
    EXPECT_EQ(light.up, 0.0);
  }
}

// Light absorbed between two depths = loss of net flux between them: alpha * (direct + down + up) is minus
// the slope of (direct + down - up). Checked with central differences, error O(h^2) = 1e-8.
TEST(Spp, AbsorbsWhatTheNetFluxLoses) {
  const SlabMedium<double> medium{0.1, 0.4, 0.3};
  const double thickness = 5.0, h = 1e-4;
  const auto net = [&](double depth) {
    const auto light = spp(depth, thickness - depth, medium);
    return light.direct + light.down - light.up;
  };
  for (const double depth : {0.3, 1.0, 2.5, 4.7}) {
    const auto light = spp(depth, thickness - depth, medium);
    EXPECT_NEAR((net(depth - h) - net(depth + h)) / (2 * h),
                medium.absorption * (light.direct + light.down + light.up), 1e-8);
  }
}

// At 60 degrees in a spherical canopy m = 0.5 / cos 60 = 1 and both backscatters alike: SPP-H is SPP.
TEST(SppH, EqualsSppWhereDiffuseLightHasTheBeamsCosine) {
  const SlabLight<double> a = spp(1.2, 2.3, SlabMedium<double>{0.2, 0.4, 0.0});
  const SlabLight<double> b = spp_h(1.2, 2.3, {0.2, 0.4, 0.4, 0.0, 1.0});
  EXPECT_NEAR(a.down, b.down, 1e-13);
  EXPECT_NEAR(a.up, b.up, 1e-13);
}

}  // namespace
}  // namespace sunfleck
