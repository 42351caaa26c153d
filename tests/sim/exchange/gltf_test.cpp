// A .glb read back by the letters of the specification: chunks, accessors within their views, area of all
// triangles, and every tree where it stands.
#include "sim/exchange/gltf.h"

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "sim/plant/text_file.h"
#include "tests/sim/plant/crown_fixture.h"
#include "tests/sim/plant/refusal.h"

namespace sunfleck {
namespace {

using nlohmann::json;

struct Glb {
  json doc;
  std::string bin;
};

std::uint32_t word(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

Glb read_glb(const std::filesystem::path& path) {
  const std::string bytes = read_text_file(path);
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(word(bytes, 4), 2u);
  EXPECT_EQ(word(bytes, 8), bytes.size());
  const std::uint32_t json_size = word(bytes, 12);
  EXPECT_EQ(json_size % 4, 0u);
  EXPECT_EQ(bytes.substr(16, 4), "JSON");
  const std::size_t bin_at = 20 + json_size;
  EXPECT_EQ(word(bytes, bin_at), bytes.size() - bin_at - 8);
  EXPECT_EQ(bytes.substr(bin_at + 4, 4), std::string("BIN\0", 4));
  return {json::parse(bytes.substr(20, json_size)), bytes.substr(bin_at + 8)};
}

template <class T>
std::vector<T> read_accessor(const Glb& glb, std::size_t accessor, int type, const std::string& shape) {
  const json& a = glb.doc["accessors"][accessor];
  const json& view = glb.doc["bufferViews"][a["bufferView"].get<std::size_t>()];
  EXPECT_EQ(a["componentType"], type);
  EXPECT_EQ(a["type"], shape);
  std::vector<T> values(a["count"].get<std::size_t>());
  EXPECT_EQ(view["byteLength"].get<std::size_t>(), values.size() * sizeof(T));
  EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0u);
  EXPECT_LE(view["byteOffset"].get<std::size_t>() + values.size() * sizeof(T), glb.bin.size());
  std::memcpy(values.data(), glb.bin.data() + view["byteOffset"].get<std::size_t>(),
              values.size() * sizeof(T));
  return values;
}

// Area of the triangles whose material name begins so.
double area_of(const Glb& glb, const json& mesh, const std::string& part) {
  double area = 0;
  for (const json& primitive : mesh["primitives"]) {
    const std::string name = glb.doc["materials"][primitive["material"].get<std::size_t>()]["name"];
    if (name.rfind(part, 0) != 0) continue;
    const auto p = read_accessor<Vec3f>(glb, primitive["attributes"]["POSITION"], 5126, "VEC3");
    const auto corners = read_accessor<std::uint32_t>(glb, primitive["indices"], 5125, "SCALAR");
    EXPECT_EQ(corners.size() % 3, 0u);
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
      const Vec3 a(p.at(corners[i])), b(p.at(corners[i + 1])), c(p.at(corners[i + 2]));
      area += 0.5 * glm::length(glm::cross(b - a, c - a));
    }
    const json& bounds = glb.doc["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
    for (const Vec3f& each : p)
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(each[axis], bounds["min"][static_cast<std::size_t>(axis)].get<float>());
        EXPECT_LE(each[axis], bounds["max"][static_cast<std::size_t>(axis)].get<float>());
      }
  }
  return area;
}

Forest two_species() {
  Forest forest;
  forest.name = "pair";
  forest.prototypes = {crown_prototype(test::broadleaf(), test::crooked_crown(), {60, 300, 4}),
                       crown_prototype(test::conifer(), test::crooked_crown(), {40, 200, 5}),
                       crown_prototype(test::broadleaf(), test::crooked_crown(), {60, 10, 6})};  // unused
  for (const Prototype& p : forest.prototypes)
    if (forest.materials.size() < 2) forest.materials.push_back({p.materials[0], {}});
  Instance a, b, c;
  a.position_m = {1, 2, 3};
  b.position_m = {-4, 5, 0};
  b.yaw_rad = 0.7f;
  b.scale = 1.25f;
  c = b;
  c.prototype.value = 1;
  c.position_m.x = 10;
  forest.instances = {a, b, c};
  return forest;
}

// Where glTF puts a point of a node: root rotation after the node's own transform.
Vec3 placed(const json& node, const Vec3& p) {
  const double angle = node.contains("rotation") ? 2 * std::atan2(node["rotation"][2].get<double>(),
                                                                  node["rotation"][3].get<double>())
                                                 : 0.0;
  const double scale = node.contains("scale") ? node["scale"][0].get<double>() : 1.0;
  const Vec3 turned(std::cos(angle) * p.x - std::sin(angle) * p.y,
                    std::sin(angle) * p.x + std::cos(angle) * p.y, p.z);
  return scale * turned + Vec3(node["translation"][0], node["translation"][1], node["translation"][2]);
}

TEST(Gltf, MeshesOnceTreesWhereTheyStandAreaKept) {
  const Forest forest = two_species();
  const auto path = test::scratch_dir() / "pair.glb";
  const GltfReport report = export_gltf(forest, path);
  const Glb glb = read_glb(path);
  EXPECT_EQ(report.meshes, 2u);  // the unused prototype is not written
  EXPECT_EQ(report.nodes, 3u);
  EXPECT_EQ(report.bytes, std::filesystem::file_size(path));
  ASSERT_EQ(glb.doc["meshes"].size(), 2u);
  ASSERT_EQ(glb.doc["nodes"].size(), 4u);
  EXPECT_NEAR(area_of(glb, glb.doc["meshes"][0], "leaf_"), 60, 60 * 1e-5);
  EXPECT_EQ(area_of(glb, glb.doc["meshes"][1], "leaf_"), 0);
  EXPECT_GT(area_of(glb, glb.doc["meshes"][1], "shoot_"), 1);
  EXPECT_GT(area_of(glb, glb.doc["meshes"][1], "wood_"), 1);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 p(0.3, -0.8, 7);
    // Double throughout but for the yaw's float.
    EXPECT_NEAR(glm::distance(placed(glb.doc["nodes"][i], p), world_from_tree(forest.instances[i], p)), 0,
                1e-6);
  }
  const json& root = glb.doc["nodes"][3];
  EXPECT_EQ(root["children"].size(), 3u);
  EXPECT_NEAR(root["rotation"][0].get<double>(), -std::sqrt(0.5), 1e-12);  // z up becomes y up
  EXPECT_EQ(glb.doc["scenes"][0]["nodes"][0], 3);
}

TEST(Gltf, SameForestSameBytes) {
  export_gltf(two_species(), test::scratch_dir() / "a.glb");
  export_gltf(two_species(), test::scratch_dir() / "b.glb");
  EXPECT_EQ(read_text_file(test::scratch_dir() / "a.glb"), read_text_file(test::scratch_dir() / "b.glb"));
}

TEST(Gltf, RefusesWhatHasNothingToShow) {
  using test::expect_refused;
  const auto path = test::scratch_dir() / "none.glb";
  Forest forest = two_species();
  forest.instances.clear();
  expect_refused([&] { export_gltf(forest, path); }, ErrorKind::kInvalidInput, "export", "no trees", "grow");
  forest = two_species();
  forest.instances[1].position_m.x = std::nan("");
  expect_refused([&] { export_gltf(forest, path); }, ErrorKind::kInvalidInput, "", "", "");
  forest = two_species();
  forest.prototypes[0].foliage.clear();
  forest.prototypes[0].wood.clear();
  forest.instances.resize(1);
  expect_refused([&] { export_gltf(forest, path); }, ErrorKind::kInvalidInput, "export", "leaves or wood",
                 "grow");
  EXPECT_FALSE(std::filesystem::exists(path));
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(export_gltf(two_species(), path, {stop.get_token(), {}}), Error);
}

}  // namespace
}  // namespace sunfleck
