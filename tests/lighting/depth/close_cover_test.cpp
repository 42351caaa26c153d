// What the closest leaves fill of a leaf's view: two leaves whose share is known, the plain twin on random
// leaves, scales and turns that change nothing, and leaves that all lie in one place.
#include "lighting/depth/close_cover.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/base/parallel.h"
#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"
#include "tests/lighting/depth/flat_leaf.h"

namespace sunfleck {
namespace {

Prototype of(std::vector<FoliageElement> foliage) {
  Prototype p;
  p.foliage = std::move(foliage);
  return p;
}

// Square leaves of side s, one a side above the other: s^2 / (pi s^2 + s^2) of one face each, nothing of the
// other face. A leaf seen edge-on fills nothing, nor does one beyond two sides.
TEST(CloseCover, OfTwoLeavesAsOnPaper) {
  const Vec3 u(0.05, 0, 0), v(0, 0.05, 0), w(0, 0, 0.05);
  const double share = 1.0 - std::exp(-1.0 / (kPi + 1.0));
  const auto facing =
      close_cover(of({test::flat_leaf({0, 0, 1}, u, v), test::flat_leaf({0, 0, 1.1}, u, v)}), {});
  EXPECT_NEAR(facing[0], share, 1e-5);  // centres are floats: 1e-6 of their distance
  EXPECT_NEAR(facing[1], share, 1e-5);
  const auto edge_on =
      close_cover(of({test::flat_leaf({0, 0, 1}, u, v), test::flat_leaf({0, 0, 1.1}, u, w)}), {});
  EXPECT_NEAR(edge_on[0], 0.0, 1e-6);
  const auto far =
      close_cover(of({test::flat_leaf({0, 0, 1}, u, v), test::flat_leaf({0, 0, 1.201}, u, v)}), {});
  EXPECT_EQ(far[0], 0.0f);
  EXPECT_TRUE(close_cover(Prototype{}, {}).empty());
}

Prototype with_shoots() {
  Prototype p = generated_crown({.kind = CrownKind::kClumped, .leaves = 3000, .seed = 5}).prototypes[0];
  for (std::size_t i = 0; i < p.foliage.size(); i += 3) {
    FoliageElement& e = p.foliage[i];
    e.shape = ElementShape::kShoot;
    e.half_v_m = 0.2f * e.half_v_m;
  }
  return p;
}

// Single against double precision: sums of up to some dozen shares, each to some 1e-6.
TEST(CloseCover, FastFormEqualsItsPlainTwin) {
  const Prototype p = with_shoots();
  const auto cover = close_cover(p, {});
  double sum = 0.0;
  for (std::size_t e = 0; e < p.foliage.size(); e += 7) {
    ASSERT_NEAR(cover[e], close_cover_plain(p, e), 2e-5) << e;
    sum += cover[e];
  }
  EXPECT_GT(sum, 0.1 * static_cast<double>(p.foliage.size()) / 7);  // there was something to compare
}

TEST(CloseCover, SameForEveryInstanceAndAnyThreads) {
  Forest forest = generated_crown({.kind = CrownKind::kClumped, .leaves = 5000, .seed = 6});
  forest.instances.push_back({{9, 0, 0}, {}, 1.0f, 2.0f, {}});
  std::vector<float> one, two;
  with_threads(1, [&] { one = close_cover(forest, {}); });
  with_threads(2, [&] { two = close_cover(forest, {}); });
  EXPECT_EQ(one, two);
  EXPECT_EQ(one, [&] {
    std::vector<float> twice = close_cover(forest.prototypes[0], {});
    twice.insert(twice.end(), twice.begin(), twice.begin() + 5000);
    return twice;
  }());
}

// 20,000 leaves within a hair, one far away: a part of them stands for all, and every answer is a share.
TEST(CloseCover, ManyLeavesInOnePlace) {
  RandomStream random(1, 0, RandomPurpose::kTestScene);
  std::vector<FoliageElement> foliage;
  for (int i = 0; i < 20000; ++i)
    foliage.push_back(test::flat_leaf(Vec3(random.uniform(), random.uniform(), random.uniform()) * 1e-3,
                                      {0.05, 0, 0}, {0, 0.05, 0}));
  foliage.push_back(test::flat_leaf({30, 0, 0}, {0.05, 0, 0}, {0, 0.05, 0}));
  const auto cover = close_cover(of(std::move(foliage)), {});
  for (const float c : cover) ASSERT_TRUE(c >= 0.0f && c <= 2.0f) << c;
  EXPECT_EQ(cover.back(), 0.0f);
  EXPECT_GT(cover[10000], 1.9f);
}

}  // namespace
}  // namespace sunfleck
