// Element geometry by hand-computed cases, and prototypes with a mistake.
#include "sim/plant/prototype.h"

#include <cmath>
#include <limits>

#include "sim/plant/flat_elements.h"
#include "tests/sim/plant/refusal.h"

namespace sunfleck {
namespace {

FoliageElement element(ElementShape shape, Vec3f u, Vec3f v, float area_m2) {
  FoliageElement e;
  e.shape = shape;
  e.centre_m = {1, 2, 3};
  e.half_u_m = u;
  e.half_v_m = v;
  e.area_m2 = area_m2;
  return e;
}

void expect_box(const Box& box, const Vec3& lo, const Vec3& hi) {
  EXPECT_NEAR(glm::distance(box.lo, lo), 0, 1e-6);
  EXPECT_NEAR(glm::distance(box.hi, hi), 0, 1e-6);
}

TEST(Element, AreaNormalAndBoundsOfEachShape) {
  // Rectangle 4 x 2 in the xy plane; right triangle of legs 3 and 6 (corner at centre - (1, 2)); disc of
  // radius 2; shoot of length 2 along z and radius 0.5.
  const auto rectangle = element(ElementShape::kParallelogram, {2, 0, 0}, {0, 1, 0}, 8);
  EXPECT_DOUBLE_EQ(element_geometric_area(rectangle), 8);
  EXPECT_EQ(element_normal(rectangle), Vec3(0, 0, 1));
  expect_box(element_bounds(rectangle), {-1, 1, 3}, {3, 3, 3});
  const auto triangle = element(ElementShape::kTriangle, {3, 0, 0}, {0, 6, 0}, 9);
  EXPECT_DOUBLE_EQ(element_geometric_area(triangle), 9);
  expect_box(element_bounds(triangle), {0, 0, 3}, {3, 6, 3});
  const auto disc = element(ElementShape::kDisc, {0, 2, 0}, {0, 0, 2}, 12.566371f);
  EXPECT_NEAR(element_geometric_area(disc), 4 * kPi, 1e-12);
  EXPECT_EQ(element_normal(disc), Vec3(1, 0, 0));
  expect_box(element_bounds(disc), {1, 0, 1}, {1, 4, 5});
  const auto shoot = element(ElementShape::kShoot, {0, 0, 1}, {0.5f, 0, 0}, 0.25f);
  EXPECT_EQ(element_geometric_area(shoot), 0.25);
  expect_box(element_bounds(shoot), {0.5, 1.5, 2}, {1.5, 2.5, 4});
}

TEST(Element, TriangleFromCornersComesBack) {
  const Vec3 a(1, 0, 2), b(4, 1, 2), c(2, 5, 7);
  const FoliageElement e = make_triangle(a, b, c);
  Box corners;
  for (const Vec3& p : {a, b, c}) corners.include(p);
  expect_box(element_bounds(e), corners.lo, corners.hi);
  EXPECT_NEAR(e.area_m2, 0.5 * glm::length(glm::cross(b - a, c - a)), 1e-5);
}

TEST(Prototype, MistakesAreRefused) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Prototype good;
  good.materials = {"leaf"};
  good.foliage = {element(ElementShape::kParallelogram, {2, 0, 0}, {0, 1, 0}, 8)};
  good.wood = {{{0, 0, 0}, {0, 0, 1}, 0.1f, 0.05f, 0}};
  good.wood_mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0}};
  EXPECT_NO_THROW(validate(good, "tree"));
  const std::pair<std::function<void(Prototype&)>, const char*> mistakes[] = {
      {[=](Prototype& p) { p.foliage[0].centre_m.x = nan; }, "tree: foliage element 0"},
      {[](Prototype& p) { p.foliage[0].area_m2 = -1; }, "tree: foliage element 0"},
      {[](Prototype& p) { p.foliage[0].area_m2 = 8.1f; }, "tree: foliage element 0"},
      {[](Prototype& p) { p.foliage[0].material = 1; }, "tree: foliage element 0"},
      {[](Prototype& p) { p.wood[0].radius_to_m = -0.1f; }, "tree: wood segment 0"},
      {[](Prototype& p) { p.wood[0].material = 3; }, "tree: wood segment 0"},
      {[=](Prototype& p) { p.wood_mesh[0].b_m.y = nan; }, "tree: wood triangle 0"}};
  for (const auto& [spoil, where] : mistakes) {
    Prototype bad = good;
    spoil(bad);
    test::expect_refused([&] { validate(bad, "tree"); }, ErrorKind::kInvalidInput, where, "", "");
  }
}

}  // namespace
}  // namespace sunfleck
