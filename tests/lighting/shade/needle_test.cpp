// One needle: golden vectors (quadrature of the definition), closed values, float against double, limits.
#include "lighting/shade/needle.h"

#include <gtest/gtest.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "sim/base/random.h"
#include "sim/base/vec.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

Vec3 vec_of(const nlohmann::json& v) { return {v[0].get<double>(), v[1].get<double>(), v[2].get<double>()}; }

Vec3 any_direction(RandomStream& random) {
  const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * kPi), r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

// The definition: mean over the apparent width of f(N) where N.V > 0 and N.L > 0, by midpoints in azimuth.
template <class Light>
double by_quadrature(const Vec3& axis, const Vec3& v, const Vec3& l, const Light& f) {
  const Basis basis = basis_around(axis);
  const double sine = std::sqrt(std::max(0.0, 1 - glm::dot(axis, v) * glm::dot(axis, v)));
  const int steps = 20000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double turn = 2 * kPi * (i + 0.5) / steps;
    const Vec3 n = std::cos(turn) * basis.tangent + std::sin(turn) * basis.bitangent;
    if (glm::dot(n, v) > 0 && glm::dot(n, l) > 0) sum += f(n) * glm::dot(n, v) / sine;
  }
  return 0.5 * sum * 2 * kPi / steps;
}

TEST(Needle, GoldenDiffuse) {
  const auto cases = test::golden("pine.json").at("level1_needle");
  ASSERT_EQ(cases.size(), 24u);
  double worst = 0;
  for (const auto& c : cases) {
    const auto angles = needle_angles(vec_of(c["axis"]), vec_of(c["V"]), vec_of(c["L"]));
    const double expected = c["Rd_quadrature"];
    worst = std::max(worst, std::abs(needle_diffuse(angles) - expected));
    EXPECT_NEAR(angles.sin_view, c["sv"].get<double>(), 1e-12);
    EXPECT_NEAR(needle_diffuse_quick(angles), expected, kQuickDiffuseError);
  }
  EXPECT_LT(worst, 2e-6);  // twice the stated error of the quadrature
  std::cout << "worst diffuse error " << worst << "\n";
}

TEST(Needle, GoldenHighlightOfExponent100) {
  double worst = 0;
  const nlohmann::json golden = test::golden("pine.json");
  for (const auto& c : golden.at("level1_needle")) {
    const double value = needle_specular(vec_of(c["axis"]), vec_of(c["V"]), vec_of(c["L"]), 100.0);
    worst = std::max(worst, std::abs(value - c["Rs_n100_quadrature"].get<double>()));
  }
  EXPECT_LT(worst, 0.0025);  // the header's bound for n = 100
}

// 3000 pairs per exponent against quadrature; bounds are those of the header, the printed form must break
// them.
TEST(Needle, HighlightErrorsAreThoseStated) {
  RandomStream random(5, 0, RandomPurpose::kTestScene);
  for (const auto& [n, bound] : {std::pair{20.0, 0.02}, {50.0, 0.006}, {100.0, 0.003}}) {
    double worst = 0, worst_printed = 0;
    for (int i = 0; i < 300; ++i) {
      const Vec3 axis = any_direction(random), v = any_direction(random), l = any_direction(random);
      const Vec3 half = glm::normalize(v + l);
      const double truth = by_quadrature(
          axis, v, l, [&](const Vec3& normal) { return std::pow(std::max(0.0, glm::dot(normal, half)), n); });
      worst = std::max(worst, std::abs(needle_specular(axis, v, l, n) - truth));
      worst_printed = std::max(worst_printed, std::abs(needle_specular_printed(axis, v, l, n) - truth));
    }
    std::cout << "n = " << n << ": worst " << worst << ", printed form " << worst_printed << "\n";
    EXPECT_LT(worst, bound);
    EXPECT_GT(worst_printed, bound);
  }
}

TEST(Needle, ClosedValues) {
  const Vec3 axis(0, 0, 1), x(1, 0, 0), y(0, 1, 0);
  EXPECT_NEAR(needle_diffuse(needle_angles(axis, x, x)), kPi / 4, 1e-14);  // int cos^2 over the seen half
  EXPECT_NEAR(needle_diffuse(needle_angles(axis, x, y)), 0.25, 1e-14);
  EXPECT_NEAR(needle_diffuse(needle_angles(axis, x, -x)), 0, 1e-14);
  EXPECT_EQ(needle_opacity(2.0, 0.1, 0.5, 10.0), 0.02);
  EXPECT_EQ(needle_opacity(2.0, 0.1, 0.5, 1e-9), 1.0);
}

// The bound of the quick form, over all azimuths: reached (so it is not loose) and kept.
TEST(Needle, QuickDiffuseKeepsItsBound) {
  double worst = 0;
  for (int i = 0; i <= 100000; ++i) {
    const NeedleAngles<double> angles{1, 1, std::cos(kPi * i / 100000)};
    worst = std::max(worst, std::abs(needle_diffuse(angles) - needle_diffuse_quick(angles)));
  }
  EXPECT_LT(worst, kQuickDiffuseError);
  EXPECT_GT(worst, 0.95 * kQuickDiffuseError);
}

// What goes in comes out, at most: light reflected into all directions of view, each with its apparent width,
// is pi/2 s_l times 2 r l / pi ... the cylinder's irradiated width: int Rd 2 s_v dV = pi * 2 s_l / pi * ...
// For a white Lambertian cylinder: int (1/pi) Rd * 2 r s_v dOmega = 2 r s_l.
TEST(Needle, ReflectsWhatItReceives) {
  const Vec3 axis(0, 0, 1);
  for (const double zenith : {0.1, 0.7, 1.5}) {
    const Vec3 l(std::sin(zenith), 0, std::cos(zenith));
    double sum = 0;
    const int rows = 400, columns = 400;
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < columns; ++j) {
        const double z = -1 + 2 * (i + 0.5) / rows, turn = 2 * kPi * (j + 0.5) / columns;
        const double s = std::sqrt(1 - z * z);
        const Vec3 v(s * std::cos(turn), s * std::sin(turn), z);
        sum += needle_diffuse(needle_angles(axis, v, l)) * s * 4 * kPi / (rows * columns);
      }
    EXPECT_NEAR(sum / kPi, std::sin(zenith), 2e-4);  // midpoint rule at the ends z = +-1
  }
}

TEST(Needle, SymmetricBetweenViewAndLight) {
  RandomStream random(7, 0, RandomPurpose::kTestScene);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 a = any_direction(random), v = any_direction(random), l = any_direction(random);
    const auto forth = needle_angles(a, v, l), back = needle_angles(a, l, v);
    EXPECT_NEAR(needle_diffuse(forth) * forth.sin_view, needle_diffuse(back) * back.sin_view, 1e-13);
  }
}

template <class Real>
glm::vec<3, Real> cast(const Vec3& v) {
  return {static_cast<Real>(v.x), static_cast<Real>(v.y), static_cast<Real>(v.z)};
}

TEST(Needle, FloatFollowsDouble) {
  RandomStream random(8, 0, RandomPurpose::kTestScene);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 a = any_direction(random), v = any_direction(random), l = any_direction(random);
    const auto wide = needle_angles(a, v, l);
    const auto narrow = needle_angles(cast<float>(a), cast<float>(v), cast<float>(l));
    if (wide.sin_view < 1e-2 || wide.sin_light < 1e-2) continue;  // the sine itself loses there
    EXPECT_NEAR(needle_diffuse(narrow), needle_diffuse(wide), 4e-5);
    EXPECT_NEAR(needle_specular(cast<float>(a), cast<float>(v), cast<float>(l), 50.0f),
                needle_specular(a, v, l, 50.0), 2e-4);
  }
}

// Along the axis, V = L, V = -L, tiny deviations: finite, never negative, never above 1.
template <class Real>
void sweep_limits() {
  using V = glm::vec<3, Real>;
  std::vector<V> directions;
  for (const Real tiny : {Real(0), Real(1e-30), Real(1e-12), Real(1e-6), Real(1e-3)})
    for (const V& d : {V(tiny, 0, 1), V(0, tiny, -1), V(1, 0, tiny), V(-1, tiny, 0), V(0, 1, tiny)})
      directions.push_back(glm::normalize(d));
  for (const V& a : directions)
    for (const V& v : directions)
      for (const V& l : directions) {
        const auto angles = needle_angles(a, v, l);
        for (const Real value :
             {needle_diffuse(angles), needle_diffuse_quick(angles), needle_specular(a, v, l, Real(20)),
              needle_specular(a, v, l, Real(1e4)), needle_specular_printed(a, v, l, Real(100))}) {
          EXPECT_TRUE(std::isfinite(value));
          EXPECT_GE(value, Real(0));
          EXPECT_LE(value, Real(1));
        }
      }
}
TEST(Needle, LimitsInDouble) { sweep_limits<double>(); }
TEST(Needle, LimitsInFloat) { sweep_limits<float>(); }

}  // namespace
}  // namespace sunfleck
