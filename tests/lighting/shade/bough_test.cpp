// Invariants of the bough's closed forms: depth against quadrature, additivity, energy, limits, the fast form
// against its plain twin, events against expectations, the choice between needles and bough.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "lighting/shade/bough_light.h"
#include "lighting/shade/lane_math.h"
#include "lighting/shade/needle_detail.h"
#include "sim/base/error.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

Vec3 any_direction(RandomStream& random) {
  const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * kPi), r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

Bough paper(int cones) { return {{12, 4.25, 0.05, kPi / 8}, 0.9, cones, 4}; }

// Depth by adding up the extinction along the spans, midpoints in the variable that flattens its peak.
double depth_by_quadrature(const BoughVolume& v, const Vec3& origin, const BoughDirection& d) {
  const BoughSpans spans = bough_spans(v, origin, d);
  const double offset = std::abs(origin.x * d.across.y - origin.y * d.across.x);
  const double start = origin.x * d.across.x + origin.y * d.across.y;
  double depth = 0;
  for (int i = 0; i < spans.count; ++i) {
    const double a = std::asinh((start + spans.span[i].from * d.sine) / offset);
    const double b = std::asinh((start + spans.span[i].to * d.sine) / offset);
    const int steps = 2000;
    for (int k = 0; k < steps; ++k) {
      const double q = a + (b - a) * (k + 0.5) / steps;
      const Vec3 point = origin + (offset * std::sinh(q) - start) / d.sine * d.along;
      depth += bough_extinction(v, point, d) * offset * std::cosh(q) / d.sine * (b - a) / steps;
    }
  }
  return depth;
}

TEST(Bough, DepthIsTheIntegralOfTheExtinction) {
  RandomStream random(3, 0, RandomPurpose::kTestScene);
  for (const double aperture : {0.05, kPi / 8, 1.0, 1.5})
    for (const int cones : {0, 1, 10}) {
      Bough bough = paper(cones);
      bough.cone.aperture_rad = aperture;
      const BoughVolume v = bough_volume(bough);
      for (int i = 0; i < 200; ++i) {
        const BoughDirection d = bough_direction(v, any_direction(random));
        const Vec3 through(random.uniform(-1, 1) * v.outer_radius, random.uniform(-1, 1) * v.outer_radius,
                           random.uniform(-2, 10));
        const Vec3 origin = through - random.uniform(0, 20) * d.along;
        const double depth = bough_depth(v, origin, d);
        EXPECT_NEAR(depth, depth_by_quadrature(v, origin, d), 2e-6 + 2e-5 * depth);
      }
    }
}

// Where a span begins or ends the ray crosses a border: inside between, outside just before and behind.
TEST(Bough, SpansAreTheInside) {
  RandomStream random(4, 0, RandomPurpose::kTestScene);
  for (const double aperture : {0.2, kPi / 8, 1.2}) {
    Bough bough = paper(6);
    bough.cone.aperture_rad = aperture;
    const BoughVolume v = bough_volume(bough);
    const auto inside = [&](const Vec3& p) {
      const double rho = std::hypot(p.x, p.y), height = p.z - rho / std::tan(aperture);
      return rho < v.outer_radius && height >= v.lowest && height <= v.highest;
    };
    for (int i = 0; i < 500; ++i) {
      const BoughDirection d = bough_direction(v, any_direction(random));
      const Vec3 origin = Vec3(0, 0, 3) + 3.0 * any_direction(random) - 12.0 * d.along;
      const BoughSpans spans = bough_spans(v, origin, d);
      for (int k = 0; k < 600; ++k) {
        const double s = 0.05 * (k + random.uniform());
        bool in_span = false, near_border = false;
        for (int j = 0; j < spans.count; ++j) {
          in_span |= s > spans.span[j].from && s < spans.span[j].to;
          near_border |= std::min(std::abs(s - spans.span[j].from), std::abs(s - spans.span[j].to)) < 1e-9;
        }
        if (!near_border) {
          ASSERT_EQ(in_span, inside(origin + s * d.along)) << "at " << s;
        }
      }
    }
  }
}

// A long finite bough has its needles: total projected needle area = covered area as needles get thin.
TEST(Bough, FiniteBoughKeepsItsNeedles) {
  Bough bough = paper(12);
  bough.cone.radius = 1e-5;
  const BoughVolume v = bough_volume(bough);
  RandomStream random(6, 0, RandomPurpose::kTestScene);
  for (const Vec3& to : {Vec3(1, 0, 0), glm::normalize(Vec3(1, 1, 1)), glm::normalize(Vec3(0.1, 0, -1))}) {
    const BoughDirection d = bough_direction(v, to);
    const Basis basis = basis_around(d.along);
    double depth = 0;
    const int side = 500;
    const double half = 9;
    for (int i = 0; i < side * side; ++i) {  // stratified
      const double a = half * (2 * (i % side + random.uniform()) / side - 1);
      const double b = half * (2 * (i / side + random.uniform()) / side - 1);
      const Vec3 origin = Vec3(0, 0, 7) + a * basis.tangent + b * basis.bitangent - 30.0 * d.along;
      depth += bough_depth(v, origin, d) * 4 * half * half / (side * side);
    }
    double area = 0;  // 12 whorls, all azimuths
    for (int k = 0; k < 1000; ++k) {
      const double turn = 2 * kPi * (k + 0.5) / 1000, s = std::sin(kPi / 8);
      const Vec3 axis(s * std::cos(turn), s * std::sin(turn), std::cos(kPi / 8));
      area += 12 * 12 * 2e-5 * 4.25 * glm::length(glm::cross(axis, d.along)) / 1000;
    }
    EXPECT_NEAR(depth / area, 1, 0.01);  // stratified points of a peaked depth: 0.3 %
  }
}

// The vector form against the plain one in double precision with many points.
TEST(Bough, FastLightFollowsItsTwin) {
  RandomStream random(5, 0, RandomPurpose::kTestScene);
  for (const int cones : {0, 1, 10}) {
    const BoughVolume v = bough_volume(paper(cones));
    double worst = 0, off = 0, mean = 0, worst_opacity = 0;
    for (int i = 0; i < 4000; ++i) {
      const BoughDirection ray = bough_direction(v, any_direction(random));
      const BoughDirection sun = bough_direction(v, any_direction(random));
      const Vec3 through(random.uniform(-1.6, 1.6), random.uniform(-1.6, 1.6), random.uniform(0, 12));
      const Vec3 origin = through - 30.0 * ray.along;
      const BoughLight fast = bough_light(v, origin, ray, sun);
      const BoughLight exact = bough_light_exact(v, origin, ray, sun);
      worst = std::max(worst, std::abs(fast.reflected - exact.reflected));
      off += std::abs(fast.reflected - exact.reflected);
      mean += exact.reflected;
      worst_opacity = std::max(worst_opacity, std::abs(fast.opacity - exact.opacity));
    }
    std::cout << cones << " whorls: light off by " << 100 * off / mean << " % of the mean, worst " << worst
              << "; opacity worst " << worst_opacity << "\n";
    EXPECT_LT(off / mean, 0.01);
    EXPECT_LT(worst, 0.08);  // rays close by the axis, where eight points are few
    EXPECT_LT(worst_opacity, 0.02);
  }
}

TEST(Bough, EventsAreDrawnFromTheExpectation) {
  RandomStream random(6, 0, RandomPurpose::kTestScene);
  const BoughVolume v = bough_volume(paper(10));
  for (int i = 0; i < 12; ++i) {
    const BoughDirection ray = bough_direction(v, any_direction(random));
    const BoughDirection sun = bough_direction(v, any_direction(random));
    const Vec3 origin = Vec3(random.uniform(-1, 1), random.uniform(-1, 1), 6) - 30.0 * ray.along;
    const BoughLight expected = bough_light_exact(v, origin, ray, sun);
    const int draws = 20000;  // stratified over `uniform`
    double hits = 0, light = 0;
    for (int k = 0; k < draws; ++k) {
      const auto event = bough_event(v, origin, ray, (k + 0.5) / draws);
      if (!event) continue;
      hits += 1.0 / draws;
      light += event_light(v, ray, *event, sun) / draws;
      ASSERT_NEAR(bough_depth(v, origin, ray) > 0, true, 0);
    }
    EXPECT_NEAR(hits, expected.opacity, 2.0 / draws);
    EXPECT_NEAR(light, expected.reflected, 2e-3 * expected.opacity + 1e-6);  // the exact form's quadrature
  }
}

// Light in = light out at most: mean over viewers of reflected light, Lambertian needles of albedo 1.
TEST(Bough, ReflectsNoMoreThanItReceives) {
  const BoughVolume v = bough_volume(paper(0));
  for (const double zenith : {0.5, 1.2, 2.4}) {
    const Vec3 l(std::sin(zenith), 0, std::cos(zenith));
    double out = 0;
    RandomStream random(7, 0, RandomPurpose::kTestScene);
    const int draws = 4000;
    for (int i = 0; i < draws; ++i) {
      const Vec3 to_viewer = any_direction(random);
      const double sine = std::hypot(to_viewer.x, to_viewer.y);
      // per unit length of bough, a strip of width 2R has apparent area 2R sine
      out += bough_strip(v, v.outer_radius, to_viewer, l, 8).reflected * sine * 4 / draws;
    }
    const double received = bough_strip(v, v.outer_radius, l, l, 64).opacity * std::hypot(l.x, l.y);
    EXPECT_LE(out, received * 1.03) << zenith;  // noise of 4000 directions: 1 %
    EXPECT_GT(out, 0.3 * received);
  }
}

TEST(Bough, ViewAndLightMayBeExchanged) {
  RandomStream random(8, 0, RandomPurpose::kTestScene);
  const BoughVolume v = bough_volume(paper(0));
  for (int i = 0; i < 50; ++i) {
    const Vec3 a = any_direction(random), b = any_direction(random);
    if (std::hypot(a.x, a.y) < 0.2 || std::hypot(b.x, b.y) < 0.2) continue;
    const double forth = bough_strip(v, v.outer_radius, a, b, 64).reflected * std::hypot(a.x, a.y);
    const double back = bough_strip(v, v.outer_radius, b, a, 64).reflected * std::hypot(b.x, b.y);
    // The hot spot's correlation is measured along the light's way only: that alone is not symmetric.
    EXPECT_NEAR(forth, back, 0.06 * std::max(forth, back) + 2e-3);
  }
}

TEST(Bough, FiniteOverDecadesAndAtEveryLimit) {
  const std::vector<Vec3> directions = {{0, 0, 1},
                                        {0, 0, -1},
                                        {1, 0, 0},
                                        {0, 1, 0},
                                        glm::normalize(Vec3(1e-12, 0, 1)),
                                        glm::normalize(Vec3(1e-3, 0, -1)),
                                        glm::normalize(Vec3(1, 0, 1e-9)),
                                        Vec3(std::sin(kPi / 8), 0, std::cos(kPi / 8)),
                                        Vec3(-std::sin(kPi / 8), 0, -std::cos(kPi / 8)),
                                        glm::normalize(Vec3(1, 2, 3))};
  for (const double radius : {1e-7, 1e-4, 1e-2, 0.3})
    for (const double spacing : {1e-4, 1e-2, 1.0, 100.0})
      for (const double aperture : {1e-3, kPi / 8, 1.57})
        for (const int cones : {0, 1, 1000}) {
          const Bough bough{{12, 1, radius, aperture}, spacing, cones, 4};
          const BoughVolume v = bough_volume(bough);
          for (const Vec3& r : directions)
            for (const Vec3& l : directions) {
              const BoughDirection ray = bough_direction(v, r), sun = bough_direction(v, l);
              for (const Vec3& through :
                   {Vec3(0, 0, 0), Vec3(1e-9, 0, 0.1), Vec3(0.3 * v.outer_radius, 0, 0.5)}) {
                const BoughLight light = bough_light(v, through - 3.0 * ray.along, ray, sun);
                ASSERT_TRUE(std::isfinite(light.opacity) && std::isfinite(light.reflected));
                ASSERT_GE(light.opacity, 0);
                ASSERT_LE(light.opacity, 1);
                ASSERT_GE(light.reflected, 0);
                ASSERT_LE(light.reflected, light.opacity);
                const auto event = bough_event(v, through - 3.0 * ray.along, ray, 0.5);
                if (event) {
                  ASSERT_TRUE(std::isfinite(event->distance) && is_finite(event->point));
                }
              }
            }
        }
}

TEST(Bough, LaneMathKeepsItsErrors) {
  for (double x = -79; x < 79; x += 0.0317)
    EXPECT_NEAR(lane_exp(static_cast<float>(x)) / std::exp(static_cast<double>(static_cast<float>(x))), 1,
                5e-6);
  for (double x = 1e-30; x < 1e30; x *= 1.0173) {
    const float f = static_cast<float>(x);
    EXPECT_NEAR(lane_log(f), std::log(static_cast<double>(f)), 1e-6 + 2e-7 * std::abs(std::log(x)));
  }
  for (int i = -10000; i <= 10000; ++i) {
    const float x = static_cast<float>(i) / 10000;
    EXPECT_NEAR(lane_acos(x), std::acos(static_cast<double>(x)), 2e-6);
  }
}

TEST(Bough, NeedlesOrBoughByFootprint) {
  const Bough bough = paper(10);  // 3.35 across, needles 0.1
  EXPECT_EQ(bough_pixels_within(0.02), 1);
  EXPECT_NEAR(bough_pixels_within(0.03), 2, 1e-12);
  EXPECT_NEAR(bough_pixels_within(0.042), 4, 1e-12);
  EXPECT_EQ(bough_pixels_within(0), 0);
  EXPECT_EQ(bough_share(bough, 0.19, 1), 0);    // needles half a pixel wide
  EXPECT_EQ(bough_share(bough, 100, 0.02), 1);  // a thirtieth of a pixel
  const double width = 2 * (4.25 * std::sin(kPi / 8) + 0.05);
  EXPECT_NEAR(bough_share(bough, width, 0.02), 0.5, 1e-12);  // at the threshold
  EXPECT_NEAR(bough_share(bough, width / 1.2, 0.02), 0, 1e-12);
  EXPECT_NEAR(bough_share(bough, width / 0.8, 0.02), 1, 1e-12);
  EXPECT_EQ(choose_needle_detail(bough, width, 0.02, 0.49), NeedleDetail::kBough);
  EXPECT_EQ(choose_needle_detail(bough, width, 0.02, 0.51), NeedleDetail::kNeedles);
  EXPECT_EQ(choose_needle_detail(bough, 1e9, 0, 0), NeedleDetail::kNeedles);  // no error allowed
}

TEST(Bough, RefusesNonsense) {
  EXPECT_THROW(bough_volume({{12, 1, 0.1, 0.4}, 0, 3, 2}), Error);
  EXPECT_THROW(bough_volume({{12, 1, 0.1, 0.4}, 1, -3, 2}), Error);
  EXPECT_THROW(bough_volume({{12, 1, 0.1, 0.4}, 1, 3, -2}), Error);
  EXPECT_THROW(bough_volume({{0, 1, 0.1, 0.4}, 1, 3, 2}), Error);
}

}  // namespace
}  // namespace sunfleck
