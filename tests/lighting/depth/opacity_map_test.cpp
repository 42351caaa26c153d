// Opacity maps against Beer's law in closed form and against hit counts known on paper.
#include "lighting/depth/opacity_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "lighting/depth/opacity_neighbours.h"
#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"
#include "tests/lighting/depth/flat_leaf.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

Prototype lone_leaf(double half_side_m) {
  Prototype p;
  p.materials = {"leaf"};
  p.foliage = {test::flat_leaf({0, 0, 1}, {half_side_m, 0, 0}, {0, half_side_m, 0})};
  return p;
}

TEST(OpacityMap, ALeafDoesNotShadeItself) {
  for (const double half_side : {0.5e-3, 0.05, 500.0})
    for (const Vec3& light : {Vec3(0, 0, 1), Vec3(1, 0, 0), glm::normalize(Vec3(1, 2, 3)), Vec3(0, 0, -1)}) {
      const Prototype p = lone_leaf(half_side);
      const OpacityMap map(p, light, 64, {});
      const OpticalDepths depths = map.around(p.foliage[0]);
      EXPECT_NEAR(depths.before, 0.0, 1e-9);
      EXPECT_NEAR(depths.behind, 0.0, 1e-9);
    }
}

// A leaf of 1 m2 above and below: texels are 1.5 m wide, the upper leaf covers 1 / 2.25 of its texel, so the
// light that comes through is 1 - 1 / 2.25 where both sit in the middle of one texel.
TEST(OpacityMap, ALeafLetsThroughWhatItsTexelLeavesOpen) {
  Prototype p = lone_leaf(0.5);
  p.foliage.push_back(test::flat_leaf({0, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}));
  const OpacityMap map(p, {0, 0, 1}, 64, {});
  ASSERT_NEAR(map.layout().texel_m, 1.5, 1e-6);
  // The leaf's centre lies 1/3 texel from the box's corner: shares 0.5 + 1/3 and 0.5 - 1/3 of two texels.
  double through = 0.0;
  const double near = 0.5 + 1.0 / 3.0, far = 1.0 - near;
  for (const double w : {near * near, near * far, far * near, far * far}) through += w * (1.0 - w / 2.25);
  EXPECT_NEAR(std::exp(-map.around(p.foliage[1]).before), through, 1e-5);
  EXPECT_NEAR(map.around(p.foliage[0]).before, 0.0, 1e-6);
  EXPECT_GT(map.around(p.foliage[0]).behind, 0.1);
}

TEST(OpacityMap, AStemIsOpaqueAndAnEdgeIsNot) {
  Prototype p;
  p.materials = {"leaf"};
  p.wood = {{Vec3f(0, 0, 0), Vec3f(0, 0, 10), 1.0f, 1.0f, 0}};
  const OpacityMap side(p, {1, 0, 0}, 64, {});
  EXPECT_GT(side.at({-2, 0, 5}).before, 3.0);  // twenty texels of depth 0 .. 8 behind a stem of 2 m
  EXPECT_EQ(side.at({2, 0, 5}).before, 0.0);
  EXPECT_EQ(side.at({-2, 1.5, 5}).before, 0.0);
  const OpacityMap end(p, {0, 0, 1}, 64, {});  // without end caps: nothing to see from above
  EXPECT_EQ(end.at({0, 0, -1}).before, 0.0);

  Prototype leaf = lone_leaf(0.5);
  const OpacityMap edge(leaf, {1, 0, 0}, 64, {});
  EXPECT_EQ(edge.at({-2, 0, 1}).before, 0.0);
}

// A direction and its opposite swap before and behind, up to their interpolation: -log of the mean
// transmission of four texels is never above their mean depth (Jensen), and below it by about half the
// variance between texels. Leaves cover up to 0.44 of a texel, so that variance is about 0.1 of the depth:
// gap 5 %, bound 8 %.
TEST(OpacityMap, OppositeDirectionsSwapBeforeAndBehind) {
  const Forest forest = generated_crown({CrownKind::kSphere, 3000, 1.0, 2.0, 5});
  const Prototype& p = forest.prototypes[0];
  const Vec3 light = glm::normalize(Vec3(0.3, -0.5, 0.8));
  const OpacityMap there(p, light, 32, {}), back(p, -light, 32, {});
  double difference = 0.0, sum = 0.0;
  for (const FoliageElement& e : p.foliage) {
    difference += there.around(e).behind - back.around(e).before;
    sum += there.around(e).behind;
  }
  EXPECT_GT(difference / sum, -1e-3);
  EXPECT_LT(difference / sum, 0.08);
}

// Black random leaves over a periodic cell, LAI L, spherical: Beer's law 1 - exp(-L / (2 cos zenith)). The
// mean of e^-depth below the layer over 40 x 40 points is the gap. 10,000 leaves of LAI 1 hide each other's
// shadow edges: standard deviation of the gap of one random cell about sqrt(A_leaf G / (cos cell)) ~ 0.005;
// the bound below is 5 % of the intercepted light.
double intercepted(const Forest& forest, double zenith_deg) {
  const Vec3 light = direction_from_azimuth_zenith(0.7, radians_from_degrees(zenith_deg));
  const OpacityMap map(forest.prototypes[0], light, 128, {});
  std::vector<PlacedMap> placed{{&map, Vec3(0.0), 1.0, 0.0, 1.0, prototype_bounds(forest.prototypes[0])}};
  const OpacityNeighbours neighbours(forest, placed, light);
  const std::vector<Neighbour> around = neighbours.around(0);
  const Box box = prototype_bounds(forest.prototypes[0]);
  double through = 0.0;
  constexpr int n = 40;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const Vec3 p(forest.period->origin_m.x + (i + 0.5) / n * forest.period->size_m.x,
                   forest.period->origin_m.y + (j + 0.5) / n * forest.period->size_m.y, box.lo.z - 0.01);
      through += std::exp(-map.at(p).before - neighbours.at(around, p).before);
    }
  return 1.0 - through / (n * n);
}

TEST(OpacityMap, InterceptsWhatBeersLawDoes) {
  const nlohmann::json cases = test::golden("light_cases.json");
  int tested = 0;
  for (const auto& c : cases["cases"]) {
    const std::string id = c["id"];
    if (id != "beer_spherical_LAI1" && id != "beer_spherical_LAI2") continue;
    ++tested;
    const double lai = c["inputs"]["LAI"];
    const Forest forest = generated_layer({lai, 4.0, 1.0, 20000, 11});
    for (const int zenith : {0, 20, 50, 75}) {
      const double truth = c["expected"]["intercept_direct_sza" + std::to_string(zenith)];
      const double value = intercepted(forest, zenith);
      std::printf("%s at %d degrees: intercepted %.4f, Beer %.4f (%+.1f %%)\n", id.c_str(), zenith, value,
                  truth, 100 * (value / truth - 1));
      EXPECT_NEAR(value, truth, 0.05 * truth);
    }
  }
  EXPECT_EQ(tested, 2);
}

// Instances turned, scaled and moved: depth through the forest equals the depth through one prototype that
// holds them all. Both use their own texels: the mean over the points agrees to 3 %.
TEST(OpacityNeighbours, AddUpLikeOneLargeTree) {
  Forest forest = generated_crown({CrownKind::kSphere, 2000, 1.0, 1.0, 3});
  forest.instances[0].position_m = {1e4, -2e4, 300};
  for (int i = 1; i < 6; ++i) {
    Instance other = forest.instances[0];
    other.position_m += Vec3(1.7 * i, 0.3 * i, 0.2 * i);
    other.yaw_rad = static_cast<float>(i);
    other.scale = 1.0f + 0.1f * static_cast<float>(i);
    forest.instances.push_back(other);
  }
  const Vec3 light = glm::normalize(Vec3(1.0, 0.2, 0.3));
  Prototype all;
  all.materials = {"leaf"};
  const Vec3 origin = forest.instances[0].position_m;
  std::vector<std::unique_ptr<OpacityMap>> maps;
  std::vector<PlacedMap> placed;
  const Prototype& p = forest.prototypes[0];
  for (std::size_t i = 0; i < forest.instances.size(); ++i) {
    const Instance& instance = forest.instances[i];
    maps.push_back(
        std::make_unique<OpacityMap>(p, tree_direction_from_world(instance, light), 64, RunControl{}));
    placed.push_back({maps.back().get(), instance.position_m - origin, std::cos(instance.yaw_rad),
                      std::sin(instance.yaw_rad), instance.scale, prototype_bounds(p)});
    for (std::size_t e = 0; e < p.foliage.size(); ++e) {
      const WorldElement w = world_element(forest, i, e);
      FoliageElement copy = test::flat_leaf(w.centre_m - origin, w.half_u_m, w.half_v_m);
      all.foliage.push_back(copy);
    }
  }
  const OpacityMap whole(all, light, 256, {});
  const OpacityNeighbours neighbours(forest, placed, light);
  const auto around = neighbours.around(2);
  EXPECT_EQ(around.size(), 5u);
  double sum = 0.0, truth = 0.0;
  for (std::size_t e = 0; e < p.foliage.size(); ++e) {
    const Vec3 point = world_element(forest, 2, e).centre_m - origin;
    sum += neighbours.at(around, point).behind +
           maps[2]->at(tree_from_world(forest.instances[2], point + origin)).behind;
    truth += whole.at(point).behind;
  }
  EXPECT_NEAR(sum / truth, 1.0, 0.03);
}

// 10,000 balls of 2 m every 2 m, light at 45 degrees: rectangles reach 2.5 m across (1 row on each side) and
// 3.3 m along a projected spacing of 1.4 m (2 on each side): 3 * 5 - 1 = 14 at most.
TEST(OpacityNeighbours, LeavesOutWhatNoLineCanMeet) {
  Forest forest = generated_crown({CrownKind::kSphere, 100, 1.0, 1.0, 3});
  const Vec3 light = glm::normalize(Vec3(1.0, 0.0, 1.0));
  const OpacityMap map(forest.prototypes[0], light, 16, {});
  const Instance first = forest.instances[0];
  forest.instances.clear();
  std::vector<PlacedMap> placed;
  for (int i = 0; i < 100; ++i)
    for (int j = 0; j < 100; ++j) {
      Instance tree = first;
      tree.position_m = {2.0 * i, 2.0 * j, 0.0};
      forest.instances.push_back(tree);
      placed.push_back({&map, tree.position_m, 1.0, 0.0, 1.0, prototype_bounds(forest.prototypes[0])});
    }
  const OpacityNeighbours neighbours(forest, placed, light);
  for (const std::size_t i : {0u, 5050u, 9999u}) EXPECT_LE(neighbours.around(i).size(), 14u);
}

TEST(OpacityMap, AnEmptyPrototypeIsClear) {
  const OpacityMap map(Prototype{}, {0, 0, 1}, 64, {});
  EXPECT_EQ(map.at({1, 2, 3}).before, 0.0);
  EXPECT_EQ(map.memory_bytes(), 0u);
  const std::vector<PlacedMap> none;
  EXPECT_TRUE(OpacityNeighbours(Forest{}, none, {0, 0, 1}).complete());
}

}  // namespace
}  // namespace sunfleck
