// Our PLY comes back with its materials, and files whose indexes are wrong are refused.
#include "tests/sim/plant/crown_fixture.h"
#include "tests/sim/plant/refusal.h"

namespace sunfleck {
namespace {

const MeshMaterials kMaterials{{{"leaf_Fagus_fixture", "leaf"}}, {{"wood_Fagus_fixture", "bark"}}};

TEST(ExportPly, RoundTripKeepsLeavesAndWoodApart) {
  const Prototype tree = crown_prototype(test::broadleaf(), test::crooked_crown(), {60, 3000, 4});
  const auto path = test::scratch_dir() / "crown.ply";
  export_ply(tree, path);
  const Prototype back = import_mesh(path, kMaterials);
  ASSERT_EQ(back.foliage.size(), tree.foliage.size());
  EXPECT_NEAR(leaf_area_m2(back) / leaf_area_m2(tree), 1, 1e-5);  // corners in single precision
  for (std::size_t i = 0; i < tree.foliage.size(); ++i)
    ASSERT_GT(glm::dot(element_normal(tree.foliage[i]), element_normal(back.foliage[i])), 1 - 1e-6);
  EXPECT_EQ(back.wood_mesh.size(), 2u * 8 * 2 - 8);  // two segments of eight quads; the tip's are triangles
}

TEST(ExportPly, AnIndexTheHeadDoesNotNameIsRefused) {
  const std::string head =
      "ply\nformat ascii 1.0\ncomment material 0 leaf_Fagus_fixture\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\n"
      "property int material_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 ";
  EXPECT_EQ(import_mesh(test::write_scratch("good.ply", head + "0\n"), kMaterials).foliage.size(), 1u);
  test::expect_refused([&] { import_mesh(test::write_scratch("bad.ply", head + "1\n"), kMaterials); },
                       ErrorKind::kInvalidInput, "bad.ply:15", "material_index", "0 to 0");
}

}  // namespace
}  // namespace sunfleck
