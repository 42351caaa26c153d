// Sixteen rays at a time against their plain twin, march_from_cell(), and a box whose depths are known.
#include "lighting/depth/march_lanes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lighting/depth/grid_march.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

GridLayout layout_of(const std::array<int, 3>& cells, const Vec3& cell_m, bool wraps) {
  GridLayout layout;
  layout.lo_m = Vec3(-1.3, 0.7, 0.2);
  layout.cell_m = cell_m;
  layout.cells = cells;
  layout.wraps_xy = wraps;
  return layout;
}

std::vector<float> random_extinction(const GridLayout& layout, double largest_per_m) {
  RandomStream random(7, 0, RandomPurpose::kTestScene);
  std::vector<float> extinction(layout.cell_count());
  for (float& e : extinction)
    e = random.below(3) == 0 ? 0.0f : static_cast<float>(random.uniform(0, largest_per_m));
  return extinction;
}

std::vector<MarchStart> random_starts(const GridLayout& layout, std::size_t count) {
  std::vector<MarchStart> starts;
  for (std::size_t i = 0; i < count; ++i) {
    RandomStream random(8, i, RandomPurpose::kTestScene);
    const Vec3f point(layout.lo_m + layout.size_m() * Vec3(random.uniform(0.001, 0.999),
                                                           random.uniform(0.001, 0.999),
                                                           random.uniform(0.001, 0.999)));
    starts.push_back(
        {point, layout.flat(layout.cell_of(Vec3(point))), static_cast<float>(random.uniform(0, 1))});
  }
  return starts;
}

Vec3 random_unit(std::uint64_t seed) {
  RandomStream random(9, seed, RandomPurpose::kTestScene);
  return glm::normalize(Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
}

void expect_twins(const GridLayout& layout, const std::vector<float>& extinction, const Vec3& direction,
                  std::size_t count) {
  const std::vector<MarchStart> starts = random_starts(layout, count);
  const MarchLine line = march_line(layout, extinction, direction);
  for (const MarchGroup group : {march_group_best(), march_group_v3}) {
    std::vector<float> depths(count);
    for (std::size_t i = 0; i < count; i += kMarchLanes)
      group(line, std::span(starts).subspan(i, std::min(kMarchLanes, count - i)), depths.data() + i);
    for (std::size_t i = 0; i < count; ++i) {
      const double plain = march_from_cell(layout, extinction, layout.unflat(starts[i].cell),
                                           Vec3(starts[i].point_m), direction, starts[i].own_per_m);
      // Ways to faces are floats of up to some hundred cells: 1e-7 of them, summed over as many.
      ASSERT_NEAR(depths[i], plain, 3e-5 * plain + 1e-5) << i;
    }
  }
}

TEST(MarchLanes, AgreeWithThePlainMarch) {
  for (const bool wraps : {false, true}) {
    for (const std::array<int, 3>& cells :
         {std::array{20, 30, 25}, std::array{1, 1, 40}, std::array{3, 3, 3}}) {
      const GridLayout layout = layout_of(cells, {0.1, 0.13, 0.09}, wraps);
      const std::vector<float> extinction = random_extinction(layout, wraps ? 0.5 : 20.0);
      for (std::uint64_t seed = 0; seed < 8; ++seed) {
        Vec3 direction = random_unit(seed);
        if (wraps) direction.z = std::copysign(std::abs(direction.z) + 0.1, direction.z);
        expect_twins(layout, extinction, direction, 75);  // the last group is not full
      }
    }
  }
}

TEST(MarchLanes, FollowAxesAndDiagonals) {
  const GridLayout layout = layout_of({12, 12, 12}, Vec3(0.25), false);
  const std::vector<float> extinction = random_extinction(layout, 3.0);
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (x != 0 || y != 0 || z != 0) expect_twins(layout, extinction, Vec3(x, y, z), 32);
}

// Level rays of a period go around until nothing is left of them, or 256 times through a thin one.
TEST(MarchLanes, EndOnLevelWaysThroughAPeriod) {
  const GridLayout layout = layout_of({8, 8, 8}, Vec3(0.25), true);
  const std::vector<float> dense(layout.cell_count(), 2.0f), empty(layout.cell_count(), 0.0f);
  const std::vector<MarchStart> starts = random_starts(layout, kMarchLanes);
  std::array<float, kMarchLanes> depths{};
  march_group_best()(march_line(layout, dense, {1, 0, 0}), starts, depths.data());
  for (const float depth : depths) EXPECT_EQ(depth, static_cast<float>(kLargestDepth));
  march_group_best()(march_line(layout, empty, {0.6, 0.8, 0}), starts, depths.data());
  for (const float depth : depths) EXPECT_EQ(depth, 0.0f);
}

// Even extinction: the way to the border of the box times it, less what is the ray's own in its first cell.
TEST(MarchLanes, MeasureTheWayThroughABox) {
  const GridLayout layout = layout_of({40, 40, 40}, Vec3(0.05), false);
  const std::vector<float> even(layout.cell_count(), 1.5f);
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Vec3 direction = random_unit(seed);
    const std::vector<MarchStart> starts = random_starts(layout, kMarchLanes);
    std::array<float, kMarchLanes> depths{};
    march_group_best()(march_line(layout, even, direction), starts, depths.data());
    for (std::size_t i = 0; i < kMarchLanes; ++i) {
      const auto way_out = [&](const Vec3& lo, const Vec3& size) {
        double way = 1e30;
        for (int a = 0; a < 3; ++a)
          way = std::min(way,
                         (lo[a] + (direction[a] > 0 ? size[a] : 0.0) - starts[i].point_m[a]) / direction[a]);
        return way;
      };
      const auto cell = layout.unflat(starts[i].cell);
      const double own_m =
          way_out(layout.lo_m + Vec3(cell[0], cell[1], cell[2]) * layout.cell_m, layout.cell_m);
      const double expected = 1.5 * way_out(layout.lo_m, layout.size_m()) - starts[i].own_per_m * own_m;
      EXPECT_NEAR(depths[i], expected, 1e-5 * expected + 1e-6);
    }
  }
}

}  // namespace
}  // namespace sunfleck
