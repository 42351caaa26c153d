// The parts of the links method: directions in 32 bits, lobes.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "lighting/links/link_ends.h"
#include "lighting/links/link_lobes.h"
#include "lighting/links/link_rays.h"
#include "sim/base/random.h"
#include "tests/lighting/trace/scenes.h"

namespace sunfleck::links {
namespace {

TEST(LinkEnds, DirectionsComeBack) {
  RandomStream random(3, 0, RandomPurpose::kTestScene);
  double worst = 0.0;
  const auto check = [&](const Vec3& d) {
    const std::uint32_t end = sky_end(d);
    EXPECT_TRUE(is_sky(end));
    worst = std::max(worst, glm::length(sky_direction(end) - d));
  };
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) check(axis), check(-axis);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (glm::length(p) > 1e-3) check(glm::normalize(p));
  }
  for (int i = 0; i < 1000; ++i) {  // along the horizon
    const double turn = random.uniform(0, 2 * kPi), z = 1e-4 * random.uniform();
    const Vec3 d = glm::normalize(Vec3(std::cos(turn), std::sin(turn), z + 1e-9));
    check(d);
    EXPECT_GT(sky_direction(sky_end(d)).z, 0.0);
  }
  EXPECT_LT(worst, 2e-4);  // steps of 6e-5 and 3e-5 on the octahedron, stretched up to threefold
}

// A tree of one leaf of this normal, or of one shoot.
Forest one_leaf(const Vec3& normal) {
  const Basis basis = basis_around(normal);
  return test::forest_of({test::quad({0, 0, 1}, 0.1 * basis.tangent, 0.1 * basis.bitangent)});
}

// Shares of the hemisphere above the horizon are known, all rays are dealt out, and every ray looks where its
// lobe does.
TEST(LinkRays, AreDealtOutOverTheLobes) {
  for (const int links : {16, 17, 64, 256})
    for (const double z : {-1.0, -0.999999999, -0.99, -0.7, -1e-9, 0.0, 0.3, 0.95, 1.0}) {
      const Vec3 normal(std::sqrt(1 - z * z), 0, z);
      const SurfaceRays rays = rays_of_surface({one_leaf(normal), PrototypeId{0}}, 0, links, 5);
      int all = 0;
      for (std::size_t l = 0; l < kLobes; ++l) {
        all += rays[l].links;
        EXPECT_EQ(rays[l].links == 0, rays[l].weight == 0.0) << z;
        EXPECT_GE(rays[l].rays.size(), static_cast<std::size_t>(rays[l].links));
        const bool up = l == kFrontUp || l == kBackUp, front = l == kFrontUp || l == kFrontDown;
        for (const LinkRay& r : rays[l].rays) {
          EXPECT_NEAR(glm::length(r.direction), 1.0, 1e-12);
          EXPECT_GT((front ? 1 : -1) * glm::dot(r.direction, normal), -1e-7);
          EXPECT_GT((up ? 1 : -1) * r.direction.z, -1e-6) << z << " " << l;
          EXPECT_EQ(r.from.front, front);
        }
      }
      EXPECT_EQ(all, 2 * links);
      EXPECT_DOUBLE_EQ(rays[kFrontUp].weight + rays[kFrontDown].weight, 1.0);
      EXPECT_DOUBLE_EQ(rays[kBackUp].weight + rays[kBackDown].weight, 1.0);
      EXPECT_NEAR(rays[kFrontUp].weight, 0.5 * (1 + z), 1e-6);
    }
}

TEST(LinkRays, ShootsShareThemEvenly) {
  const Forest forest = test::forest_of({test::shoot({0, 0, 1}, {0.1, 0, 0}, 0.02, 0.01)});
  const SurfaceRays rays = rays_of_surface({forest, PrototypeId{0}}, 0, 64, 5);
  for (const LobeRays& lobe : rays) {
    EXPECT_EQ(lobe.links, 32);
    EXPECT_EQ(lobe.weight, 0.5);
  }
}

// A face's two lobes together are its cosine-weighted hemisphere: its mean direction is 2/3 of the normal.
// Midpoints of a 200 x 200 grid, from the map over both faces and from that of one lobe: good to 2e-3.
TEST(LinkLobes, MakeUpTheCosineHemispheres) {
  constexpr int kGrid = 200;
  for (const Vec3& n :
       {Vec3(0, 0, 1), Vec3(0.6, 0, 0.8), Vec3(0, 1, 0), Vec3(0, -0.8, -0.6), Vec3(0, 0, -1)}) {
    std::array<Vec3, kLobes> sums{}, alone{};
    std::array<double, kLobes> counts{};
    for (int i = 0; i < kGrid * kGrid; ++i)
      for (const Half half : {Half::kUp, Half::kDown}) {
        const double a = (i % kGrid + 0.5) / kGrid, b = (i / kGrid + 0.5) / kGrid;
        const LeafDirection d = leaf_direction(n, half, a, b);
        EXPECT_TRUE(half == Half::kUp ? d.direction.z > -1e-7 : d.direction.z < 1e-7) << d.direction.z;
        sums[lobe_of(half, d.front)] += d.direction;
        counts[lobe_of(half, d.front)] += 1;
        for (const bool front : {true, false})
          alone[lobe_of(half, front)] += lobe_direction(front ? n : -n, half, a, b);
      }
    for (const bool front : {true, false}) {
      Vec3 together(0), apart(0);
      for (const Half half : {Half::kUp, Half::kDown}) {
        const Lobe lobe = lobe_of(half, front);
        EXPECT_NEAR(counts[lobe] / (kGrid * kGrid), lobe_weight(lobe, n.z), 5e-3);
        if (counts[lobe] > 0) together += lobe_weight(lobe, n.z) / counts[lobe] * sums[lobe];
        apart += lobe_weight(lobe, n.z) / (kGrid * kGrid) * alone[lobe];
      }
      EXPECT_LT(glm::length(together - (front ? 2.0 : -2.0) / 3.0 * n), 5e-3);
      EXPECT_LT(glm::length(apart - (front ? 2.0 : -2.0) / 3.0 * n), 2e-3);
    }
  }
}

}  // namespace
}  // namespace sunfleck::links
