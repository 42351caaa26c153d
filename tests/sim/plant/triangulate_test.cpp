// Triangles of a polygon cover its area, also at concave corners, in any plane.
#include <cmath>

#include "sim/plant/flat_elements.h"
#include "tests/sim/plant/refusal.h"

namespace sunfleck {
namespace {

double covered_m2(const std::vector<Vec3>& p) {
  double area = 0;
  for (const auto& t : triangulate(p))
    area += 0.5 * glm::length(glm::cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]));
  return area;
}

Vec3 tilted(double x, double y) { return x * Vec3(0.6, 0, 0.8) + y * Vec3(0, 1, 0) + Vec3(3, -2, 5); }

TEST(Triangulate, CoversConcavePolygonsExactly) {
  // An L of three unit squares; an arrow head of area 1/2 * 4 * 3 - 1/2 * 4 * 1 = 4; a comb with two gaps.
  const std::vector<Vec3> l = {tilted(0, 0), tilted(2, 0), tilted(2, 1),
                               tilted(1, 1), tilted(1, 2), tilted(0, 2)};
  EXPECT_NEAR(covered_m2(l), 3, 1e-12);
  const std::vector<Vec3> arrow = {tilted(0, 1), tilted(-2, 0), tilted(0, 3), tilted(2, 0)};
  EXPECT_NEAR(covered_m2(arrow), 4, 1e-12);
  const std::vector<Vec3> comb = {tilted(0, 0), tilted(5, 0), tilted(5, 2), tilted(4, 2),
                                  tilted(4, 1), tilted(3, 1), tilted(3, 2), tilted(2, 2),
                                  tilted(2, 1), tilted(1, 1), tilted(1, 2), tilted(0, 2)};
  EXPECT_NEAR(covered_m2(comb), 8, 1e-12);  // 5 x 1 below, three teeth of 1 x 1
  EXPECT_NEAR(covered_m2({comb.rbegin(), comb.rend()}), 8, 1e-12);
}

TEST(Triangulate, RegularPolygonsOfAnySize) {
  for (const int n : {3, 4, 5, 17, 64}) {
    std::vector<Vec3> corners;
    for (int i = 0; i < n; ++i)
      corners.push_back(tilted(std::cos(2 * kPi * i / n), std::sin(2 * kPi * i / n)));
    EXPECT_NEAR(covered_m2(corners), 0.5 * n * std::sin(2 * kPi / n), 1e-12);
    EXPECT_EQ(triangulate(corners).size(), static_cast<std::size_t>(n - 2));
  }
}

TEST(Triangulate, CrossedAndFlatPolygonsEnd) {
  EXPECT_EQ(triangulate(std::vector<Vec3>{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size(), 2u);
  EXPECT_EQ(triangulate(std::vector<Vec3>(7, Vec3(1, 1, 1))).size(), 5u);
}

}  // namespace
}  // namespace sunfleck
