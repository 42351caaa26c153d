// OBJ meshes: leaves and wood by material, the ways to write a face, and what is refused.
#include "sim/plant/make_prototype.h"
#include "tests/sim/plant/refusal.h"

namespace sunfleck {
namespace {

const MeshMaterials kMaterials{{{"green leaf", "Fagus sylvatica"}, {"twig_leaf", "Picea abies"}},
                               {{"bark", "Fagus sylvatica"}}};

Prototype import_text(std::string_view text, ImportReport* report = nullptr) {
  return import_mesh(test::write_scratch("tree.obj", text), kMaterials, report);
}

constexpr const char* kVertices = "v 0 0 1\nv 2 0 1\nv 2 1 1\nv 0 1 1\nv 1 3 1\n";

TEST(Obj, LeavesAndWoodByMaterial) {
  ImportReport report;
  const Prototype p = import_text(std::string("mtllib absent.mtl\no tree\n") + kVertices +
                                      "vt 0 0\nvn 0 0 1\ns off\nusemtl green leaf\n"
                                      "f 1 2 3 4\n"         // parallelogram of area 2
                                      "f 1/1 2/1/1 3//1\n"  // triangle of area 1
                                      "f -5 -4 -3 -1 -2\n"  // house: 2 + 1/2 * 2 * 2 = 4
                                      "usemtl bark\nf 1 2 3 4\n"
                                      "usemtl twig_leaf\nf 1 2 3\nf 1 1 2\n",
                                  &report);
  EXPECT_EQ(p.materials, (std::vector<std::string>{"Fagus sylvatica", "Picea abies"}));
  EXPECT_EQ(report.parallelograms, 1u);
  EXPECT_EQ(report.triangles, 1u + 3u + 1u);
  EXPECT_EQ(report.wood_triangles, 2u);
  EXPECT_EQ(report.degenerate_skipped, 1u);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("skipped 1 faces"), std::string::npos);
  EXPECT_NEAR(leaf_area_m2(p), 2 + 1 + 4 + 1, 1e-5);
  EXPECT_EQ(p.foliage.back().material, 1);
  EXPECT_EQ(p.wood_mesh.size(), 2u);
}

TEST(Obj, GroupNameStandsInForAMissingMaterial) {
  const Prototype p = import_text(std::string(kVertices) + "g bark\nf 1 2 3\n");
  EXPECT_EQ(p.wood_mesh.size(), 1u);
  EXPECT_TRUE(p.foliage.empty());
}

TEST(Obj, MistakesAreRefusedWithFileAndLine) {
  struct Case {
    std::string text;
    const char *where, *problem, *remedy;
  };
  const std::string v = std::string(kVertices) + "usemtl bark\n";
  const Case cases[] = {
      {"", "tree.obj", "no leaf and no wood", "at least one"},
      {v, "tree.obj", "no leaf and no wood", "at least one"},
      {v + "f 1 1 1\n", "tree.obj", "no leaf and no wood", "at least one"},
      {v + "f 1 2 6\n", "tree.obj:7", "corner 6 is no vertex", "1 to 5"},
      {v + "f 1 2 0\n", "tree.obj:7", "corner 0 is no vertex", "1 to 5"},
      {v + "f 1 2 -6\n", "tree.obj:7", "corner -6 is no vertex", "-5"},
      {v + "f 1 2 99999999999999999999\n", "tree.obj:7", "not an integer", "whole"},
      {v + "f 1 2 a\n", "tree.obj:7", "\"a\" is not an integer", "whole"},
      {v + "f 1 2\n", "tree.obj:7", "three corners", "f a b c"},
      {"v 1 2\n", "tree.obj:1", "three coordinates", "v x y z"},
      {"v 1 2 nan\n", "tree.obj:1", "not a finite number", "1.25"},
      {"v 1 2 1e7\n", "tree.obj:1", "10 km", "origin"},
      {std::string(kVertices) + "f 1 2 3\n", "tree.obj:6", "\"\" is neither leaf nor wood", "\"bark\""},
      {v + "usemtl stone\nf 1 2 3\n", "tree.obj:8", "\"stone\" is neither leaf nor wood", "\"green leaf\""},
  };
  for (const Case& each : cases)
    test::expect_refused([&] { import_text(each.text); }, ErrorKind::kInvalidInput, each.where, each.problem,
                         each.remedy);
  test::expect_refused([] { import_mesh("absent.obj", kMaterials); }, ErrorKind::kNotFound, "absent.obj",
                       "no such", "path");
  test::expect_refused([] { import_mesh("tree.fbx", kMaterials); }, ErrorKind::kInvalidInput, "tree.fbx",
                       "no mesh format", "*.obj");
  test::expect_refused(
      [] {
        import_mesh("t.obj", {{{"a", "x"}}, {{"a", "y"}}});
      },
      ErrorKind::kInvalidInput, "\"a\"", "leaf and as wood", "choose");
}

}  // namespace
}  // namespace sunfleck
