// Cells of leaf-area grids: the size rule, margins, periods, the cap, and points for what exceeds a cell.
#include "lighting/depth/grid_layout.h"

#include <gtest/gtest.h>

#include "lighting/depth/spread_points.h"

namespace sunfleck {
namespace {

Box box_of(const Vec3& lo, const Vec3& hi) {
  Box box;
  box.include(lo);
  box.include(hi);
  return box;
}

TEST(LeafCellSize, StaysBetweenTwoAndFourSides) {
  EXPECT_EQ(leaf_cell_size(32.0, 0.4), 1.0);    // 2.5 sides
  EXPECT_EQ(leaf_cell_size(1.0, 0.1), 0.2);     // few cells: 2 sides
  EXPECT_EQ(leaf_cell_size(1000.0, 0.1), 0.4);  // wide scene: 4 sides
  EXPECT_EQ(leaf_cell_size(0.0, 0.1), 0.2);
}

TEST(FitGrid, LeavesAMarginAroundEveryPoint) {
  for (const double extent : {1.0, 3.2, 3.999999, 4.0, 7.3}) {
    const Box box = box_of(Vec3(-0.3), Vec3(-0.3 + extent));
    const GridLayout grid = fit_grid(box, std::nullopt, 0.5, 1u << 20);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(grid.lo_m[axis] + grid.cell_m[axis], box.lo[axis] + 1e-12);
      EXPECT_GE(grid.lo_m[axis] + grid.size_m()[axis] - grid.cell_m[axis], box.hi[axis] - 1e-12);
    }
  }
}

TEST(FitGrid, HasThreeCellsWhereTheSceneIsFlat) {
  const GridLayout grid = fit_grid(box_of({0, 0, 5}, {2, 1, 5}), std::nullopt, 0.25, 1u << 20);
  EXPECT_EQ(grid.cells[2], 3);
  EXPECT_EQ(grid.cell_along(2, 5.0), 1);
}

TEST(FitGrid, CoversThePeriodExactly) {
  const GridLayout grid =
      fit_grid(box_of({0.2, 0.1, 0}, {0.9, 1.8, 1}), box_of({0, 0, 0}, {1, 2, 0}), 0.3, 1u << 20);
  EXPECT_TRUE(grid.wraps_xy);
  EXPECT_EQ(grid.cells[0], 3);
  EXPECT_EQ(grid.cells[1], 7);
  EXPECT_NEAR(grid.size_m().x, 1.0, 1e-15);
  EXPECT_NEAR(grid.size_m().y, 2.0, 1e-15);
  EXPECT_EQ(grid.lo_m.x, 0.0);
}

TEST(FitGrid, CoarsensInsteadOfExceedingTheLimit) {
  for (const double extent : {1e2, 1e4, 1e6}) {
    const GridLayout grid = fit_grid(box_of(Vec3(0), Vec3(extent, extent, 10)), std::nullopt, 0.01, 1u << 22);
    EXPECT_TRUE(grid.coarsened);
    EXPECT_LE(grid.cell_count(), std::size_t{1} << 22);
    EXPECT_GE(grid.cell_count(), std::size_t{1} << 18);  // not far below what is allowed
  }
}

TEST(GridLayout, NumbersCellsThereAndBack) {
  const GridLayout grid{.cells = {3, 5, 7}};
  for (std::uint32_t i = 0; i < grid.cell_count(); ++i) EXPECT_EQ(grid.flat(grid.unflat(i)), i);
}

WorldElement element(ElementShape shape, const Vec3& u, const Vec3& v) {
  return {.centre_m = {1, 2, 3}, .half_u_m = u, .half_v_m = v, .area_m2 = 1, .shape = shape, .material = 0};
}

// Shares sum to 1 and their centre of gravity is that of the surface.
void expect_balanced(const std::vector<SpreadPoint>& points, const Vec3& centre) {
  double sum = 0.0;
  Vec3 mean(0.0);
  for (const SpreadPoint& p : points) {
    sum += p.share;
    mean += p.share * p.point_m;
  }
  EXPECT_GT(points.size(), 10u);
  EXPECT_NEAR(sum, 1.0, 1e-12);
  EXPECT_NEAR(glm::length(mean - centre), 0.0, 1e-9);
}

TEST(SpreadPoints, AreBalancedOnEveryShape) {
  const Vec3 u(0.5, 0.1, 0), v(0, 0.4, 0.3);
  for (const ElementShape shape :
       {ElementShape::kParallelogram, ElementShape::kDisc, ElementShape::kTriangle, ElementShape::kShoot})
    expect_balanced(spread_element(element(shape, u, v), 0.1), Vec3(1, 2, 3));
}

TEST(SpreadPoints, FollowTheTaperOfACylinder) {
  // Area of a cone's side from above lies at a third of its length from the thick end.
  const auto points = spread_cylinder({{0, 0, 0}, {0, 0, 3}, 0.05, 0.0}, 0.05);
  double height = 0.0;
  for (const SpreadPoint& p : points) height += p.share * p.point_m.z;
  EXPECT_NEAR(height, 1.0, 0.01);
}

TEST(SpreadPoints, ArePointsEnoughForACell) {
  const auto e = element(ElementShape::kParallelogram, {0.5, 0, 0}, {0, 0.5, 0});
  EXPECT_FALSE(needs_spreading(e, 2.0));
  EXPECT_TRUE(needs_spreading(e, 0.9));
  EXPECT_EQ(spread_element(e, 0.5).size(), 16u);
}

}  // namespace
}  // namespace sunfleck
