// Every vector of tests/golden/envelope.json (correctly rounded doubles of 50-digit values) against the
// stable forms in double and float, and against the forms as printed, which must fail some of them.
//
// Tolerances: double |err| <= 1e-12 |ref| + 1e-30; float 4e-6 |ref| + 1e-30. The absolute term lets go what
// lies below 1e-30: Avt and G1 within 1e-10 rad of pi (the argument itself is a rounded pi) and exponentials
// of depths beyond 69.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <vector>

#include "lighting/envelope/closed_forms.h"
#include "sim/base/vec.h"
#include "tests/support/golden.h"

namespace sunfleck::envelope {
namespace {

template <class Real>
double tolerance() {
  return sizeof(Real) == 8 ? 1e-12 : 4e-6;
}

bool close_to(double value, double expected, double relative) {
  return std::abs(value - expected) <= relative * std::abs(expected) + 1e-30;
}

// Largest relative error seen, for the record.
struct Worst {
  double error = 0;
  void see(double value, double expected) {
    if (std::abs(expected) > 1e-30) error = std::max(error, std::abs(value - expected) / std::abs(expected));
  }
};

template <class Real>
AnglePair<Real> cast_pair(double angle_rad) {
  const AnglePair<double> pair = angle_pair(angle_rad);
  return {static_cast<Real>(pair.angle_rad), static_cast<Real>(pair.supplement_rad)};
}

template <class Real>
LeafSums<Real> sums(const nlohmann::json& mat) {  // [r_f, r_b, t_f, t_b]
  return {static_cast<Real>(mat[0].get<double>() + mat[1].get<double>()),
          static_cast<Real>(mat[2].get<double>() + mat[3].get<double>())};
}

template <class Real>
class Vectors : public testing::Test {
 protected:
  static void check(double value, double expected, const std::string& what) {
    EXPECT_TRUE(close_to(value, expected, tolerance<Real>()))
        << what << ": " << value << " instead of " << expected << ", relative "
        << std::abs(value - expected) / std::abs(expected);
    worst_.see(value, expected);
  }
  static void TearDownTestSuite() { std::cout << "worst relative error " << worst_.error << "\n"; }
  inline static Worst worst_;
};
using Reals = testing::Types<double, float>;
TYPED_TEST_SUITE(Vectors, Reals);

TYPED_TEST(Vectors, MeanCosines) {
  const auto vectors = test::golden("envelope.json")["av"];
  ASSERT_EQ(vectors.size(), 39u);
  for (const auto& v : vectors) {
    const auto pair = cast_pair<TypeParam>(v["alpha"]);
    this->check(mean_transmitting_cosines(pair), v["Avt"], "Avt at " + v["alpha"].dump());
    this->check(mean_reflecting_cosines(pair), v["Avr"], "Avr at " + v["alpha"].dump());
  }
}

TYPED_TEST(Vectors, ScatteringDensity) {
  const auto vectors = test::golden("envelope.json")["g1"];
  ASSERT_EQ(vectors.size(), 112u);
  for (const auto& v : vectors) {
    const auto rho = static_cast<TypeParam>(v["rho"].template get<double>());
    this->check(scattering_density(rho, v["N"].template get<int>(), sums<TypeParam>(v["mat"]),
                                   cast_pair<TypeParam>(v["alpha"])),
                v["G1"], "G1 of " + v.dump());
  }
}

TYPED_TEST(Vectors, MeanDecay) {
  const auto vectors = test::golden("envelope.json")["phi"];
  ASSERT_EQ(vectors.size(), 27u);
  for (const auto& v : vectors) {
    const double expected = v["phi"];
    if (expected > std::numeric_limits<TypeParam>::max()) continue;  // -700 does not fit a float
    this->check(mean_decay(static_cast<TypeParam>(v["x"].template get<double>())), expected,
                "phi of " + v["x"].dump());
  }
}

template <class Real>
std::vector<Direction<Real>> directions_of(const nlohmann::json& sample) {
  if (sample["dirs"] == "cube8") return {cube_directions<Real>().begin(), cube_directions<Real>().end()};
  return {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
}

// One sample case worked through, by the sheet's names.
template <class Real>
struct SampleCase {
  std::vector<Direction<Real>> directions;
  std::vector<Real> distance, weights;
  Direction<Real> to_light;
  LeafSums<Real> leaf;
  Real rho, area, tau, sum_of_cosines, s0 = 0;

  explicit SampleCase(const nlohmann::json& v) : directions(directions_of<Real>(v)) {
    const Vec3 light(v["light"][0], v["light"][1], v["light"][2]);
    to_light = Direction<Real>(light / glm::length(light));
    for (const auto& s : v["smax"]) distance.push_back(static_cast<Real>(s.template get<double>()));
    weights.resize(directions.size());
    leaf = sums<Real>(v["mat"]);
    rho = static_cast<Real>(v["rho"].template get<double>());
    area = static_cast<Real>(v["A"].template get<double>());
    tau = static_cast<Real>(0.5 * v["rho"].template get<double>() * v["A"].template get<double>());
    sum_of_cosines = interpolation_weights<Real>(directions, to_light, weights);
    s0 = interpolated<Real>(weights, distance);
  }
  int count() const { return static_cast<int>(directions.size()); }
  Real g1(std::size_t j) const {
    return scattering_density(rho, count(), leaf, angle_between<Real>(directions[j], to_light));
  }
  Real c(std::size_t j) const { return approach_towards<Real>(directions, weights, j); }
  Real integral(std::size_t j) const { return one_bounce_integral<Real>(tau * s0, c(j), tau * distance[j]); }
};

TYPED_TEST(Vectors, SampleCases) {
  using Real = TypeParam;
  const auto vectors = test::golden("envelope.json")["sample"];
  ASSERT_EQ(vectors.size(), 198u);
  std::size_t seen = 0;
  for (const auto& v : vectors) {
    const SampleCase<Real> s(v);
    this->check(s.sum_of_cosines, v["SM"], "SM of " + v["light"].dump());
    this->check(s.s0, v["S0"], "S0 of " + v["light"].dump());
    this->check(s.tau / s.sum_of_cosines, v["G2"], "G2 of " + v["light"].dump());
    for (const auto& d : v["per_dir"]) {
      const std::size_t j = d["j"];
      const std::string what = v["dirs"].dump() + v["light"].dump() + v["smax_mode"].dump() + " rho " +
                               v["rho"].dump() + " j " + d["j"].dump() + " ";
      this->check(s.g1(j), d["G1"], what + "G1");
      // c and G3 are sums of terms of either sign: their error is relative to the terms (at most 1).
      EXPECT_NEAR(s.c(j), d["c"].template get<double>(), tolerance<Real>()) << what;
      EXPECT_NEAR(s.tau * (1 - s.c(j)), d["G3"].template get<double>(), tolerance<Real>() * s.tau) << what;
      const Real published = published_sector_sample<Real>({.scattering_per_m3 = s.g1(j),
                                                            .extinction_per_m = s.tau,
                                                            .light_distance_m = s.s0,
                                                            .approach = s.c(j),
                                                            .sector_distance_m = s.distance[j],
                                                            .irradiance_w_m2 = 1});
      this->check(published, d["Losample"], what + "Losample");
      this->check(s.g1(j) / s.tau * s.integral(j), d["Losample_clamped"], what + "Losample_clamped");
      // The dimensionless form knows neither A nor rho; unclamped it is A times Eq. 23.
      const Real raw =
          std::exp(-s.tau * s.s0) * s.tau * s.distance[j] * mean_decay((1 - s.c(j)) * s.tau * s.distance[j]);
      const Real lobe = scattering_lobe(s.leaf, angle_between<Real>(s.directions[j], s.to_light));
      const Real sector = static_cast<Real>(4 * kPi) / static_cast<Real>(s.count());
      this->check(one_bounce_sector<Real>(sector, lobe, 1, raw), d["A_Losample"], what + "A_Losample");
      ++seen;
    }
  }
  EXPECT_EQ(seen, 1416u);
}

// ---- the printed forms, to keep the vectors honest: each must miss its tolerance somewhere ----------------

double printed_reflecting(double a) { return (std::sin(a) - a * std::cos(a)) / (6 * kPi); }
double printed_transmitting(double a) { return ((kPi - a) * std::cos(a) + std::sin(a)) / (6 * kPi); }
double printed_decay(double x) { return (1 - std::exp(-x)) / x; }
double printed_g1(double rho, int n, double rs, double ts, double a) {
  return 2 * rho / (3 * kPi * n) * ((rs + ts) * (std::sin(a) - a * std::cos(a)) + kPi * ts * std::cos(a));
}

TEST(PrintedForms, LoseTheMeanCosinesNearTheirZeros) {
  int reflecting = 0, transmitting = 0;
  const auto vectors = test::golden("envelope.json")["av"];
  for (const auto& v : vectors) {
    reflecting += !close_to(printed_reflecting(v["alpha"]), v["Avr"], 1e-12);
    transmitting += !close_to(printed_transmitting(v["alpha"]), v["Avt"], 1e-12);
  }
  EXPECT_GE(reflecting, 5);
  EXPECT_GE(transmitting, 5);
}

TEST(PrintedForms, LoseG1) {
  int failed = 0;
  const auto vectors = test::golden("envelope.json")["g1"];
  for (const auto& v : vectors) {
    const auto leaf = sums<double>(v["mat"]);
    failed += !close_to(printed_g1(v["rho"], v["N"], leaf.reflectance, leaf.transmittance, v["alpha"]),
                        v["G1"], 1e-12);
  }
  EXPECT_GE(failed, 3);
}

TEST(PrintedForms, DivideZeroByZeroWithoutDepth) {
  EXPECT_TRUE(std::isnan(printed_decay(0.0)));
  EXPECT_EQ(mean_decay(0.0), 1.0);
  int failed = 0;
  const auto vectors = test::golden("envelope.json")["phi"];
  for (const auto& v : vectors) failed += !close_to(printed_decay(v["x"]), v["phi"], 1e-12);
  EXPECT_GE(failed, 5);
}

TEST(PrintedForms, PromiseMoreLightThanThereIsAtTheFarEnd) {
  std::size_t negative = 0;
  const auto vectors = test::golden("envelope.json")["sample"];
  for (const auto& v : vectors) {
    for (const auto& d : v["per_dir"]) {
      if (!d["negative_far_end"]) continue;
      ++negative;
      EXPECT_GE(d["Losample"].get<double>(), d["Losample_clamped"].get<double>() * (1 - 1e-12));
    }
  }
  EXPECT_EQ(negative, 22u);
}

TEST(PrintedForms, TakeTheArcCosineOfMoreThanOne) {
  // A unit vector in floats whose square rounds to more than one: acos gives NaN, atan2 the angle 0.
  int nan = 0;
  for (int i = 1; i < 2000; ++i) {
    const float t = 0.001f * static_cast<float>(i);
    const Direction<float> a = glm::normalize(Direction<float>(std::sin(t), std::cos(t), 0.3f * t));
    nan += std::isnan(std::acos(glm::dot(a, a)));
    const auto pair = angle_between<float>(a, a);
    ASSERT_LT(pair.angle_rad, 1e-6f);
    ASSERT_NEAR(pair.supplement_rad, kPi, 1e-6);
  }
  EXPECT_GT(nan, 0);
}

}  // namespace
}  // namespace sunfleck::envelope
