// Radiance through grids whose answer is known: even light stays even, a beam fades by Beer's law, sources
// fill a column, repeating borders close.
#include <gtest/gtest.h>

#include <cmath>

#include "lighting/transport/sweep.h"
#include "lighting/transport/sweep_row.h"
#include "sim/base/random.h"

namespace sunfleck::transport {
namespace {

GridLayout layout_of(std::array<int, 3> cells, bool wraps = false) {
  GridLayout layout;
  layout.cells = cells;
  layout.cell_m = Vec3(0.5);
  layout.wraps_xy = wraps;
  return layout;
}

class Even final : public Inflow {
 public:
  float radiance(const std::array<int, 3>&) const override { return 3.0f; }
};

std::vector<Vec3> many_directions() {
  std::vector<Vec3> directions;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (x != 0 || y != 0 || z != 0) directions.push_back(glm::normalize(Vec3(x, y, z)));
  RandomStream random(5, 0, RandomPurpose::kTestScene);
  for (int i = 0; i < 40; ++i)
    directions.push_back(
        glm::normalize(Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))));
  return directions;
}

TEST(Sweep, EvenLightStaysEvenInAnyMediumThatShinesAlike) {
  const GridLayout layout = layout_of({7, 5, 9});
  RandomStream random(3, 0, RandomPurpose::kTestScene);
  std::vector<float> pass(layout.cell_count());
  for (float& t : pass) t = static_cast<float>(random.uniform());
  for (const Vec3& w : many_directions()) {
    std::vector<float> radiance(layout.cell_count(), 3.0f), around;
    sweep(plan_sweep(layout, w), pass, Even(), radiance, around, {});
    for (const float r : radiance) ASSERT_FLOAT_EQ(r, 3.0f);
  }
}

TEST(Sweep, FadesByTheHalfStepsPassed) {
  // From outside to the centre of cell n: 2 n + 1 half steps of t each.
  const GridLayout layout = layout_of({6, 6, 6});
  const std::vector<float> pass(layout.cell_count(), 0.8f);
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 w(0);
    w[axis] = -1;
    std::vector<float> radiance(layout.cell_count(), 0.0f), around;
    sweep(plan_sweep(layout, w), pass, Even(), radiance, around, {});
    for (std::uint32_t c = 0; c < radiance.size(); ++c) {
      const int n = layout.unflat(c)[static_cast<std::size_t>(axis)];
      ASSERT_NEAR(radiance[c], 3.0 * std::pow(0.8, 2 * n + 1), 1e-5);
    }
  }
}

TEST(Sweep, DiagonalsRunFromCornerToCorner) {
  // One bright cell: only cells on its diagonal see it.
  const GridLayout layout = layout_of({7, 7, 7});
  std::vector<float> pass(layout.cell_count(), 1.0f), radiance(layout.cell_count(), 0.0f), around;
  pass[layout.flat({3, 3, 3})] = 0.5f;
  radiance[layout.flat({3, 3, 3})] = 8.0f;
  sweep(plan_sweep(layout, glm::normalize(Vec3(1, -1, 1))), pass, NoInflow(), radiance, around, {});
  for (std::uint32_t c = 0; c < radiance.size(); ++c) {
    const auto [x, y, z] = layout.unflat(c);
    const bool behind = 3 - x == y - 3 && 3 - x == 3 - z && x < 3;
    const float expected = c == layout.flat({3, 3, 3}) ? 4.0f
                           : behind                    ? 6.0f
                                                       : 0.0f;  // q (1 - t), q (1 - t^2)
    ASSERT_NEAR(radiance[c], expected, 1e-5) << x << ' ' << y << ' ' << z;
  }
}

TEST(Sweep, NeverLeavesTheRangeOfItsSources) {
  const GridLayout layout = layout_of({8, 8, 8});
  RandomStream random(9, 0, RandomPurpose::kTestScene);
  for (const Vec3& w : many_directions()) {
    std::vector<float> pass(layout.cell_count()), radiance(layout.cell_count()), around;
    for (float& t : pass) t = static_cast<float>(std::exp(-std::pow(10.0, random.uniform(-9, 3))));
    for (float& q : radiance) q = static_cast<float>(random.uniform(0, 3));
    sweep(plan_sweep(layout, w), pass, Even(), radiance, around, {});
    for (const float r : radiance) {
      ASSERT_GE(r, 0.0f);
      ASSERT_LE(r, 3.000001f);
    }
  }
}

TEST(Sweep, HandsOnAroundRepeatingBorders) {
  // Along +x in a ring of 4 cells with t^2 = 1/2 each and no source: what enters is halved four times.
  const GridLayout layout = layout_of({4, 2, 2}, true);
  const std::vector<float> pass(layout.cell_count(), std::sqrt(0.5f));
  std::vector<float> radiance(layout.cell_count(), 0.0f), around(4, 16.0f);
  sweep(plan_sweep(layout, {-1, 0, 0}), pass, NoInflow(), radiance, around, {});
  ASSERT_EQ(around.size(), 4u);
  for (const float leaving : around) EXPECT_NEAR(leaving, 1.0, 1e-5);
}

TEST(Row, FormsAgree) {
  RandomStream random(4, 0, RandomPurpose::kTestScene);
  for (const int count : {1, 3, 7, 8, 15, 16, 17, 33, 64, 100}) {
    const auto n = static_cast<std::size_t>(count);
    std::vector<float> in(n + 1), across(n + 1), pass(n), plain(n), out(n), best_out(n), apart_out(n);
    for (auto* values : {&in, &across, &pass, &plain})
      for (float& x : *values) x = static_cast<float>(random.uniform());
    std::vector<float> best(plain), apart(3 * n), apart_pass(3 * n);
    for (std::size_t i = 0; i < n; ++i) {
      apart[3 * i] = plain[i];
      apart_pass[3 * i] = pass[i];
    }
    Row row{.count = count,
            .in = in.data(),
            .in_across = across.data(),
            .weights = {0.2f, 0.3f, 0.1f, 0.4f},
            .pass = pass.data(),
            .cell = plain.data(),
            .out = out.data()};
    sweep_row_plain(row);
    row.cell = best.data();
    row.out = best_out.data();
    sweep_row_best()(row);
    row.cell = apart.data();
    row.pass = apart_pass.data();
    row.out = apart_out.data();
    sweep_row_apart(row, 3);
    for (std::size_t i = 0; i < n; ++i) {  // a few roundings of numbers up to 1
      ASSERT_NEAR(plain[i], best[i], 3e-7f);
      ASSERT_NEAR(out[i], best_out[i], 3e-7f);
      ASSERT_NEAR(plain[i], apart[3 * i], 3e-7f);
      ASSERT_NEAR(out[i], apart_out[i], 3e-7f);
    }
  }
}

TEST(Plan, StepsAlongTheAxisWithTheFewestCellsAside) {
  const GridLayout layout = layout_of({4, 4, 4});
  EXPECT_EQ(plan_sweep(layout, {0.9, 0.3, 0.3}).axis, 0);
  EXPECT_EQ(plan_sweep(layout, {0.3, -0.9, 0.3}).axis, 1);
  const SweepPlan plan = plan_sweep(layout, glm::normalize(Vec3(-0.5, 0.25, 1)));
  EXPECT_EQ(plan.axis, 2);
  EXPECT_TRUE(plan.from_high_end);
  EXPECT_EQ(plan.row_shift, -1);  // half a cell towards -x: cells -1 and 0, half each
  EXPECT_NEAR(plan.row_part, 0.5, 1e-6);
  EXPECT_EQ(plan.column_shift, 0);
  EXPECT_NEAR(plan.column_part, 0.25, 1e-6);
  EXPECT_NEAR(plan.step_m, 0.5 * std::sqrt(1.3125), 1e-9);
}

}  // namespace
}  // namespace sunfleck::transport
