// The vector code of opacity maps against its plain twin: layout, depths at points and around elements.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lighting/depth/opacity_map.h"
#include "lighting/depth/opacity_neighbours.h"
#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

// Leaves of all shapes, some much larger than a texel, and a stem.
Prototype mixed_tree() {
  Prototype p = generated_crown({CrownKind::kSphere, 2000, 1.0, 5.0, 6}).prototypes[0];
  for (std::size_t i = 0; i < p.foliage.size(); ++i) {
    FoliageElement& e = p.foliage[i];
    e.shape = static_cast<ElementShape>(i % 4);
    if (i % 97 == 0) {
      e.half_u_m *= 12.0f;
      e.half_v_m *= 9.0f;
    }
    if (e.shape != ElementShape::kShoot) e.area_m2 = static_cast<float>(element_geometric_area(e));
  }
  p.wood = {{Vec3f(0, 0, 0), Vec3f(0, 0, 2), 0.1f, 0.05f, 0}};
  return p;
}

std::vector<Vec3> directions() {
  return {{0, 0, 1}, {1, 0, 0}, glm::normalize(Vec3(1, -2, 3)), glm::normalize(Vec3(-0.3, 0.2, -0.1))};
}

// Bounds are taken in float here: texels agree to 1e-6 of themselves.
TEST(OpacityRows, LayTheSameGrid) {
  const Prototype tree = mixed_tree();
  const ElementRows rows = element_rows(tree);
  for (const Vec3& s : directions()) {
    const OpacityLayout plain = opacity_layout(tree, s, 64), fast = opacity_layout(tree, rows, s, 64);
    EXPECT_NEAR(fast.texel_m, plain.texel_m, 1e-6 * plain.texel_m);
    EXPECT_NEAR(fast.slice_m, plain.slice_m, 1e-6 * plain.slice_m);
    EXPECT_NEAR(fast.lit_side_m, plain.lit_side_m, 1e-5 * plain.texel_m);
    EXPECT_EQ(fast.columns(), plain.columns());
    EXPECT_EQ(fast.slices, plain.slices);
  }
}

// A leaf on the border of two slices may fall to either side: depths then differ by what it adds over the
// length of a slice. So the worst of 2,000 is allowed a leaf's depth in its texel (0.1), their mean
// difference 1e-4.
TEST(OpacityRows, FindTheSameDepthsAroundElements) {
  const Prototype tree = mixed_tree();
  const ElementRows rows = element_rows(tree);
  for (const Vec3& s : directions()) {
    const OpacityMap plain(tree, s, 64, {}), fast(tree, rows, s, 64, {});
    EXPECT_NEAR(fast.leaf_projection(), plain.leaf_projection(), 1e-5);
    EXPECT_NEAR(fast.mean_square_cosine(), plain.mean_square_cosine(), 1e-5);
    std::vector<float> before(rows.size()), behind(rows.size());
    fast.around_all(tree, rows, 0, rows.size(), before, behind);
    double sum = 0.0;
    for (std::size_t e = 0; e < rows.size(); ++e) {
      const OpticalDepths truth = plain.around(tree.foliage[e]);
      EXPECT_NEAR(before[e], truth.before, 0.1);
      EXPECT_NEAR(behind[e], truth.behind, 0.1);
      sum += std::abs(before[e] - truth.before) + std::abs(behind[e] - truth.behind);
    }
    EXPECT_LT(sum / static_cast<double>(rows.size()), 1e-4);
  }
}

// One map, read one by one and in rows: coordinates in float are right to 1e-4 of a texel, over which depths
// change by less than 1e-3 here.
TEST(OpacityRows, ReadTheSameMap) {
  const Prototype tree = mixed_tree();
  RandomStream random(5, 0, RandomPurpose::kTestScene);
  std::vector<float> x, y, z;
  for (int i = 0; i < 3000; ++i) {
    x.push_back(static_cast<float>(random.uniform(-3, 3)));
    y.push_back(static_cast<float>(random.uniform(-3, 3)));
    z.push_back(static_cast<float>(random.uniform(-1, 5)));
  }
  for (const Vec3& s : directions()) {
    const OpacityMap map(tree, s, 64, {});
    AffineFloat to_texels;
    const Vec3 zero = map.texel_from_tree(Vec3(0.0));
    for (std::size_t row = 0; row < 3; ++row) {
      const auto r = static_cast<int>(row);
      for (std::size_t c = 0; c < 3; ++c) {
        Vec3 axis(0.0);
        axis[static_cast<int>(c)] = 1.0;
        to_texels.row[row][c] = static_cast<float>((map.texel_from_tree(axis) - zero)[r]);
      }
      to_texels.row[row][3] = static_cast<float>(zero[r]);
    }
    std::vector<float> before(x.size(), 1.0f), behind(x.size(), 2.0f);
    map.add_at(to_texels, x, y, z, before, behind);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const OpticalDepths truth = map.at({x[i], y[i], z[i]});
      ASSERT_NEAR(before[i] - 1.0f, truth.before, 1e-3);
      ASSERT_NEAR(behind[i] - 2.0f, truth.behind, 1e-3);
    }
  }
}

// Sums over the neighbours of turned and scaled trees, in rows and one by one.
TEST(OpacityRows, SumTheSameNeighbours) {
  Forest forest = generated_crown({CrownKind::kSphere, 500, 1.0, 3.0, 8});
  const Instance first = forest.instances[0];
  forest.instances.clear();
  for (int i = 0; i < 9; ++i) {
    Instance tree = first;
    tree.position_m = {1.7 * (i % 3), 1.7 * (i / 3), 0.05 * i};
    tree.scale = 0.9f + 0.03f * static_cast<float>(i);
    forest.instances.push_back(tree);
  }
  forest.period = Period{{0, 0}, {5.1, 5.1}};
  const Vec3 sun = glm::normalize(Vec3(1, 0.4, 0.8));
  const OpacityMap map(forest.prototypes[0], sun, 64, {});
  std::vector<PlacedMap> placed;
  for (const Instance& i : forest.instances)
    placed.push_back({&map, i.position_m, 1.0, 0.0, i.scale, prototype_bounds(forest.prototypes[0])});
  const OpacityNeighbours neighbours(forest, placed, sun);
  const ElementRows rows = element_rows(forest.prototypes[0]);
  for (std::size_t i = 0; i < 9; ++i) {
    const std::vector<Neighbour> around = neighbours.around(i);
    std::vector<float> before(rows.size(), 0.0f), behind(rows.size(), 0.0f);
    neighbours.add_at(around, placed[i], rows.x_m, rows.y_m, rows.z_m, before, behind);
    for (std::size_t e = 0; e < rows.size(); ++e) {
      const OpticalDepths truth =
          neighbours.at(around, placed[i].world_from_tree({rows.x_m[e], rows.y_m[e], rows.z_m[e]}));
      ASSERT_NEAR(before[e], truth.before, 2e-3);
      ASSERT_NEAR(behind[e], truth.behind, 2e-3);
    }
  }
}

}  // namespace
}  // namespace sunfleck
