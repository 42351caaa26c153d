// Exports come back: leaves with their area and place, wood as prisms, and nothing half-written is left.
#include <cmath>

#include "tests/sim/plant/crown_fixture.h"
#include "tests/sim/plant/refusal.h"

namespace sunfleck {
namespace {

MeshMaterials materials_of(const std::string& name) {
  return {{{"leaf_" + name, "leaf"}}, {{"wood_" + name, "bark"}, {"shoot_" + name, "needles"}}};
}

double wood_area_m2(const Prototype& p) {
  double area = 0;
  for (const WoodTriangle& t : p.wood_mesh)
    area += 0.5 * glm::length(glm::cross(Vec3(t.b_m) - Vec3(t.a_m), Vec3(t.c_m) - Vec3(t.a_m)));
  return area;
}

TEST(ExportObj, RoundTripKeepsLeavesAndStem) {
  const Prototype tree = crown_prototype(test::broadleaf(), test::crooked_crown(), {60, 3000, 4});
  const auto path = test::scratch_dir() / "crown.obj";
  export_obj(tree, path);
  const Prototype back = import_mesh(path, materials_of("Fagus_fixture"));
  ASSERT_EQ(back.foliage.size(), tree.foliage.size());
  EXPECT_NEAR(leaf_area_m2(back) / leaf_area_m2(tree), 1, 1e-7);
  for (std::size_t i = 0; i < tree.foliage.size(); ++i) {
    const FoliageElement &a = tree.foliage[i], &b = back.foliage[i];
    ASSERT_EQ(b.shape, ElementShape::kParallelogram);
    ASSERT_NEAR(b.area_m2 / a.area_m2, 1, 1e-5);
    ASSERT_NEAR(glm::distance(a.centre_m, b.centre_m), 0, 1e-5);
    ASSERT_GT(glm::dot(element_normal(a), element_normal(b)), 1 - 1e-9);
  }
  EXPECT_EQ(back.wood_mesh.size(), 2u * 8 * 2 - 8);  // two segments of eight quads; the tip's are triangles
}

// A disc as an octagon of its own area; a triangle; a shoot of length 2, radius 0.5 as eight sides, each as
// wide as the octagon's edge 2 * 0.5 * sin(pi / 8).
TEST(ExportObj, DiscsTrianglesAndShoots) {
  Prototype p;
  p.materials = {"a # b"};
  FoliageElement disc, triangle, shoot;
  disc.shape = ElementShape::kDisc;
  disc.half_u_m = {0, 0.3f, 0};
  disc.half_v_m = {0, 0, 0.3f};
  triangle.shape = ElementShape::kTriangle;
  triangle.half_u_m = {1, 0, 0};
  triangle.half_v_m = {0.2f, 0.7f, 0.1f};
  shoot.shape = ElementShape::kShoot;
  shoot.half_u_m = {0, 0, 1};
  shoot.half_v_m = {0.5f, 0, 0};
  shoot.area_m2 = 0.4f;
  disc.area_m2 = static_cast<float>(element_geometric_area(disc));
  triangle.area_m2 = static_cast<float>(element_geometric_area(triangle));
  p.foliage = {disc, triangle, shoot};
  const auto path = test::scratch_dir() / "shapes.obj";
  export_obj(p, path);
  const Prototype back = import_mesh(path, materials_of("a___b"));
  EXPECT_EQ(back.foliage.size(), 6u + 1u);
  EXPECT_NEAR(back.foliage.back().area_m2 / triangle.area_m2, 1, 1e-6);
  EXPECT_NEAR(leaf_area_m2(back) / (disc.area_m2 + triangle.area_m2), 1, 1e-5);
  EXPECT_NEAR(wood_area_m2(back), 8 * 2 * (2 * 0.5 * std::sin(kPi / 8)), 1e-5);
}

TEST(ExportLeafList, RoundTripKeepsDiscsAndQuads) {
  Prototype tree = crown_prototype(test::broadleaf(), test::crooked_crown(), {60, 500, 4});
  const auto discs =
      import_leaf_list(test::write_scratch("d.txt", "0.1 1 2 3 0.3 0.4 0.5\n0.2 1 2 4 0 -1 0\n"), "x");
  tree.foliage.insert(tree.foliage.end(), discs.foliage.begin(), discs.foliage.end());
  const auto path = test::scratch_dir() / "list.txt";
  EXPECT_EQ(export_leaf_list(tree, path), 0u);
  const Prototype back = import_leaf_list(path, "x");
  ASSERT_EQ(back.foliage.size(), tree.foliage.size());
  for (std::size_t i = 0; i < tree.foliage.size(); ++i) {
    const FoliageElement &a = tree.foliage[i], &b = back.foliage[i];
    ASSERT_EQ(a.shape, b.shape);
    ASSERT_NEAR(b.area_m2 / a.area_m2, 1, 1e-5);
    ASSERT_NEAR(glm::distance(a.centre_m, b.centre_m), 0, 1e-5);
    ASSERT_GT(glm::dot(element_normal(a), element_normal(b)), 1 - 1e-9);
  }
}

TEST(ExportLeafList, SaysWhatTheFormatCannotHold) {
  Prototype mixed = crown_prototype(test::conifer(), test::crooked_crown(), {60, 20, 4});
  test::expect_refused([&] { export_leaf_list(mixed, test::scratch_dir() / "none.txt"); },
                       ErrorKind::kInvalidInput, "none.txt", "no disc or parallelogram", "OBJ");
  const Prototype leaves = crown_prototype(test::broadleaf(), test::crooked_crown(), {60, 5, 4});
  mixed.foliage.insert(mixed.foliage.end(), leaves.foliage.begin(), leaves.foliage.end());
  EXPECT_EQ(export_leaf_list(mixed, test::scratch_dir() / "mixed.txt"), 20u);
}

TEST(Export, AFailureLeavesNothingBehind) {
  const Prototype tree = crown_prototype(test::broadleaf(), test::crooked_crown(), {60, 5, 4});
  const auto folder = test::scratch_dir() / "out";
  std::filesystem::create_directories(folder / "taken.obj" / "inside");
  test::expect_refused([&] { export_obj(tree, folder / "absent" / "a.obj"); }, ErrorKind::kInputOutput,
                       "a.obj", "cannot be written", "folder");
  test::expect_refused([&] { export_obj(tree, folder / "taken.obj"); }, ErrorKind::kInputOutput, "taken.obj",
                       "cannot be written", "folder");
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    EXPECT_EQ(entry.path().filename(), "taken.obj");
}

}  // namespace
}  // namespace sunfleck
