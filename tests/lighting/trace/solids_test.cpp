// Rays against cone frustums and cylinders, held against marching along the ray in small steps.
#include "lighting/trace/solids.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/base/random.h"

namespace sunfleck::trace {
namespace {

Vec3 random_point(RandomStream& random, double reach) {
  return {random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-reach, reach)};
}

// Positive outside the (unbounded) cone around the axis.
double outside_by(const ConeFrustum& cone, const Vec3& p, double& height) {
  height = glm::dot(p - cone.base, cone.axis);
  return glm::length(p - cone.base - height * cone.axis) - (cone.radius_at_base + cone.taper * height);
}

// First change of side between the caps, to 1e-3; negative if there is none.
double marched(const ConeFrustum& cone, const Vec3& origin, const Vec3& direction) {
  double height = 0.0;
  double before = outside_by(cone, origin, height);
  for (double t = 1e-3; t < 8.0; t += 1e-3) {
    const double now = outside_by(cone, origin + t * direction, height);
    if ((now < 0.0) != (before < 0.0) && height > 0.0 && height < cone.length) return t;
    before = now;
  }
  return -1.0;
}

// From a point of the inner side, moved off it by single precision either way, a ray that goes inwards must
// reach the far wall or an open end: never the outer side next to where it started.
TEST(Cone, IsLeftThroughItsFarWall) {
  RandomStream random(9, 0, RandomPurpose::kTestScene);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 base = random_point(random, 20.0);
    const ConeFrustum cone =
        cone_between(base, base + random_point(random, 1.0), 1e-3, random.uniform(2e-4, 1e-3));
    const Basis basis = basis_around(cone.axis);
    const double turn = random.uniform(0, 2 * kPi), height = random.uniform(0.1, 0.9) * cone.length;
    const Vec3 spoke = std::cos(turn) * basis.tangent + std::sin(turn) * basis.bitangent;
    const double radius = cone.radius_at_base + cone.taper * height;
    const Vec3 exact = base + height * cone.axis + radius * spoke;
    const Vec3 origin(Vec3f(exact.x, exact.y, exact.z));
    const Vec3 direction = glm::normalize(-spoke + random.uniform(-1, 1) * glm::cross(cone.axis, spoke));
    const auto hit = leave(cone, origin, direction, 1e30);
    ASSERT_TRUE(hit.has_value()) << i;
    EXPECT_FALSE(hit->from_outside) << i;
    EXPECT_GT(hit->t, 0.5 * radius) << i;
  }
}

TEST(Cone, MeetsWhereMarchingMeets) {
  RandomStream random(4, 0, RandomPurpose::kTestScene);
  int hits = 0, unlike = 0;
  for (int i = 0; i < 2000; ++i) {
    const ConeFrustum cone = cone_between(random_point(random, 1.0), random_point(random, 1.0),
                                          random.uniform(0.05, 0.6), random.uniform(0.0, 0.6));
    const Vec3 origin = random_point(random, 2.0),
               direction = glm::normalize(random_point(random, 0.5) - origin);
    const auto hit = intersect(cone, origin, direction, 0.0, 8.0);
    const double slow = marched(cone, origin, direction);
    if (hit.has_value() != (slow > 0.0) || (hit && std::abs(hit->t - slow) > 2e-3)) {
      ++unlike;  // two roots within one step, or a rim within one step
      continue;
    }
    if (!hit) continue;
    ++hits;
    double height = 0.0;
    EXPECT_NEAR(outside_by(cone, origin + hit->t * direction, height), 0.0, 1e-9);
    EXPECT_NEAR(glm::length(hit->outward_normal), 1.0, 1e-12);
    EXPECT_EQ(hit->from_outside, glm::dot(hit->outward_normal, direction) < 0.0);
  }
  EXPECT_GT(hits, 500);
  EXPECT_LT(unlike, 20);
}

TEST(Cone, FarOriginKeepsDigits) {
  const ConeFrustum twig = cone_between({0, 0, -1}, {0, 0, 1}, 0.001, 0.001);
  const auto hit = intersect(twig, {1e5, 0, 0}, {-1, 0, 0}, 0.0, 1e9);
  ASSERT_TRUE(hit.has_value());
  EXPECT_NEAR(hit->t, 1e5 - 0.001, 1e-9);
}

TEST(Cone, DegenerateOnesAreNeverHit) {
  const ConeFrustum point = cone_between({0, 0, 0}, {0, 0, 0}, 0.1, 0.1);
  EXPECT_FALSE(intersect(point, {1, 0, 0}, {-1, 0, 0}, 0.0, 9.0).has_value());
  const ConeFrustum line = cone_between({0, 0, -1}, {0, 0, 1}, 0.0, 0.0);
  EXPECT_FALSE(intersect(line, {1, 0.01, 0}, {-1, 0, 0}, 0.0, 9.0).has_value());
}

TEST(Cylinder, SpanIsWhatMarchingFinds) {
  RandomStream random(5, 0, RandomPurpose::kTestScene);
  int crossed = 0;
  for (int i = 0; i < 2000; ++i) {
    const Cylinder c{random_point(random, 0.5), glm::normalize(random_point(random, 1.0)),
                     random.uniform(0.1, 1.0), random.uniform(0.05, 0.8)};
    const Vec3 origin = random_point(random, 2.0),
               direction = glm::normalize(random_point(random, 0.5) - origin);
    double length = 0.0;
    constexpr double kStep = 2e-3;
    for (double t = -6.0; t < 6.0; t += kStep) {
      const Vec3 p = origin + t * direction - c.centre;
      const double h = glm::dot(p, c.axis);
      if (std::abs(h) < c.half_length && glm::length(p - h * c.axis) < c.radius) length += kStep;
    }
    const auto span = inside(c, origin, direction);
    EXPECT_NEAR(span ? span->leave - span->enter : 0.0, length, 2.5 * kStep);
    crossed += span ? 1 : 0;
  }
  EXPECT_GT(crossed, 300);
}

TEST(Cylinder, AlongTheAxisAndFlat) {
  const Cylinder c{{0, 0, 0}, {0, 0, 1}, 0.5, 0.2};
  const auto along = inside(c, {0.1, 0, -3}, {0, 0, 1});
  ASSERT_TRUE(along.has_value());
  EXPECT_NEAR(along->enter, 2.5, 1e-12);
  EXPECT_NEAR(along->leave, 3.5, 1e-12);
  EXPECT_FALSE(inside(c, {0.3, 0, -3}, {0, 0, 1}).has_value());
  EXPECT_FALSE(inside({{0, 0, 0}, {0, 0, 1}, 0.0, 0.2}, {0.1, 0, -3}, {0, 0, 1}).has_value());
}

}  // namespace
}  // namespace sunfleck::trace
