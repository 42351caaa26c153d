// FLIP by what must hold on paper: nothing for equal pictures, the largest for its farthest colours, and a
// step of light whose every part (blur, lightness, edge) can be written down.
#include "lighting/render/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "lighting/render/flip_colour.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

constexpr int kSide = 48;
using Colours = std::vector<double>;

Colours picture(const auto& colour) {
  Colours c;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const Vec3 rgb = colour(x, y);
      c.insert(c.end(), {rgb.x, rgb.y, rgb.z});
    }
  return c;
}
Colours even(const Vec3& rgb) {
  return picture([&](int, int) { return rgb; });
}
FlipDifference flip(const Colours& a, const Colours& b, double ppd = 67.0206) {
  return flip_difference(a, b, kSide, kSide, {ppd});
}
Colours noisy(std::uint64_t seed) {
  return picture([&](int x, int y) {
    RandomStream random(seed, static_cast<std::uint64_t>(x + 1000 * y), RandomPurpose::kTestScene);
    const double r = random.uniform(), g = random.uniform();
    return Vec3(r, g, random.uniform());
  });
}

TEST(Flip, EqualPicturesDoNotDiffer) {
  const FlipDifference d = flip(noisy(1), noisy(1));
  EXPECT_EQ(d.mean, 0);
  EXPECT_EQ(d.largest, 0);
}

TEST(Flip, LikeFromBothSides) {
  const FlipDifference ab = flip(noisy(1), noisy(2)), ba = flip(noisy(2), noisy(1));
  EXPECT_GT(ab.mean, 0.05);
  EXPECT_EQ(ab.map, ba.map);
}

// Lab of sRGB green (87.735, -86.183, 83.180) and blue (32.297, 79.188, -107.860); chroma times L / 100 and
// HyAB give 203.5, the largest; black and white are 100 apart: above the knee of .4 of the range of powers.
TEST(Flip, FarthestColours) {
  const auto hunted = [](double l, double a, double b) { return Vec3(l, l * a / 100, l * b / 100); };
  const double far = hyab(hunted(87.735, -86.183, 83.180), hunted(32.297, 79.188, -107.860));
  const double largest = std::pow(far, 0.7), knee = 0.4 * largest;
  const double black_white = 0.95 + 0.05 * (std::pow(100, 0.7) - knee) / (largest - knee);
  EXPECT_NEAR(flip(even({0, 1, 0}), even({0, 0, 1})).mean, 1, 1e-5);
  EXPECT_NEAR(flip(even({0, 0, 0}), even({1, 1, 1})).mean, black_white, 1e-4);  // three decimals of Lab
  EXPECT_NEAR(black_white, 0.967, 5e-4);
  // Light as the screen shows it: 2 is 1.
  EXPECT_EQ(flip(even({2, 2, 2}), even({1, 1, 1})).mean, 0);
}

// Left half black, right half white, against white. A pixel left of the step sees the share w of white that
// the blur (a Gaussian of sqrt(.0047 / (2 pi^2)) degrees, 1.03 pixels) leaves it; the edge has full strength
// there, the point detector less: feature = (1 / sqrt 2)^(1/2). Grey keeps its colour, so L* of w says it
// all.
TEST(Flip, AStepOfLight) {
  const Colours step = picture([](int x, int) { return x < kSide / 2 ? Vec3(0) : Vec3(1); });
  const FlipDifference d = flip(step, even({1, 1, 1}));
  const double pi2 = kPi * kPi, ppd = 67.0206;
  double white = 0, all = 0;
  for (int k = -10; k <= 10; ++k) {
    const double g = std::exp(-pi2 * k * k / (0.0047 * ppd * ppd));
    all += g;
    if (k >= 1) white += g;
  }
  const double lightness = 116 * std::cbrt(white / all) - 16;
  const double green_blue = hyab(hunt_lab_from_rgb({0, 1, 0}), hunt_lab_from_rgb({0, 0, 1}));
  const double colour = 0.95 / (0.4 * std::pow(green_blue, 0.7)) * std::pow(100 - lightness, 0.7);
  ASSERT_LT(colour, 0.95);
  const double expected = std::pow(colour, 1 - std::sqrt(1 / std::numbers::sqrt2));
  const std::size_t left_of_step = 20 * kSide + kSide / 2 - 1;
  EXPECT_NEAR(d.map[left_of_step], expected, 2e-3);  // the matrices' seven digits, chroma of 1e-5
  // Far from the step: white against white, black against white without an edge.
  EXPECT_LT(d.map[20 * kSide + kSide - 1], 1e-3);
  EXPECT_NEAR(d.map[20 * kSide], 0.967, 1e-3);
}

TEST(Flip, GrowsWithBlur) {
  const auto checks = [](int x, int y) { return (x / 4 + y / 4) % 2 == 0 ? 1.0 : 0.0; };
  const auto blurred = [&](int reach) {
    return picture([&](int x, int y) {
      double sum = 0;
      for (int i = -reach; i <= reach; ++i)
        for (int j = -reach; j <= reach; ++j) sum += checks(x + i + 64, y + j + 64);
      return Vec3(sum / ((2 * reach + 1) * (2 * reach + 1)));
    });
  };
  double before = 0;
  for (const int reach : {0, 1, 2, 3}) {
    const double now = flip(blurred(reach), blurred(0)).mean;
    if (reach > 0) {
      EXPECT_GT(now, before) << reach;
    }
    before = now;
  }
}

// Stripes a pixel wide are grey from afar: the farther, the less they differ from grey of the same light.
TEST(Flip, FinePatternsVanishWithDistance) {
  const Colours stripes = picture([](int x, int) { return x % 2 == 0 ? Vec3(1) : Vec3(0); });
  double before = 1;
  for (const double ppd : {10.0, 20.0, 40.0, 67.0, 130.0}) {
    const FlipDifference d = flip(stripes, even({0.5, 0.5, 0.5}), ppd);
    double now = 0;  // in the middle, where the rim is out of the filters' reach
    for (std::size_t y = 20; y < 28; ++y)
      for (std::size_t x = 20; x < 28; ++x) now += static_cast<double>(d.map[y * kSide + x]) / 64;
    EXPECT_LT(now, before) << ppd;
    before = now;
  }
  EXPECT_LT(before, 0.1);
}

TEST(Flip, ADotIsSeenWhereItIs) {
  const Colours grey = even({0.3, 0.3, 0.3});
  Colours dot = grey;
  const std::size_t at = 24 * kSide + 24;
  for (std::size_t c = 0; c < 3; ++c) dot[3 * at + c] = 1;
  const FlipDifference d = flip(dot, grey);
  EXPECT_EQ(d.map[at], static_cast<float>(d.largest));
  EXPECT_EQ(d.map[0], 0);  // farther than any filter reaches
  EXPECT_LT(d.mean, d.weighted_median);
}

}  // namespace
}  // namespace sunfleck
