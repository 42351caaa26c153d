// glTF 2.0 specification, sections 3.6 (accessors and buffer views), 3.5.3 (transforms) and 4.4 (GLB chunks).
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "sim/base/error.h"
#include "sim/base/pending_file.h"
#include "sim/base/version.h"
#include "sim/exchange/gltf.h"
#include "sim/exchange/gltf_mesh.h"

namespace sunfleck {
namespace {

static_assert(std::endian::native == std::endian::little);
using nlohmann::json;

constexpr int kFloat = 5126, kUnsignedInt = 5125, kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr std::size_t kMostInstances = 1'000'000, kMostBytes = 0xffffffff - 64;

class GlbWriter {
 public:
  explicit GlbWriter(const Forest& forest) : forest_(forest) {
    doc_["asset"] = {{"version", "2.0"}, {"generator", std::string("Sunfleck ") + kVersion}};
    doc_["scene"] = 0;
    doc_["buffers"] = json::array();
  }

  // Index of the mesh, or nothing for a prototype without faces.
  std::optional<std::size_t> add_mesh(const Prototype& prototype) {
    json primitives = json::array();
    for (const GltfPrimitive& p : gltf_primitives(prototype)) {
      report_.triangles += p.corners.size() / 3;
      primitives.push_back({{"attributes", {{"POSITION", add_positions(p.positions_m)}}},
                            {"indices", add_corners(p.corners)},
                            {"material", material(prototype, p)}});
    }
    if (primitives.empty()) return std::nullopt;
    doc_["meshes"].push_back({{"name", prototype.name}, {"primitives", std::move(primitives)}});
    return report_.meshes++;
  }

  void add_node(const Instance& i, std::size_t mesh) {
    json node = {{"mesh", mesh}, {"translation", {i.position_m.x, i.position_m.y, i.position_m.z}}};
    if (i.yaw_rad != 0.0f)  // about z, counter-clockwise
      node["rotation"] = {0, 0, std::sin(0.5 * i.yaw_rad), std::cos(0.5 * i.yaw_rad)};
    if (i.scale != 1.0f) node["scale"] = {i.scale, i.scale, i.scale};
    node["name"] = "tree " + std::to_string(i.tree.value);
    trees_.push_back(std::move(node));
    ++report_.nodes;
  }

  std::string file() {
    finish_nodes();
    doc_["buffers"].push_back({{"byteLength", bytes_.size()}});
    std::string text = doc_.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::size_t total = 12 + 8 + text.size() + 8 + bytes_.size();
    std::string glb = "glTF";
    for (const std::size_t word : {std::size_t{2}, total, text.size()})
      append(glb, static_cast<std::uint32_t>(word));
    glb += "JSON" + text;
    append(glb, static_cast<std::uint32_t>(bytes_.size()));
    glb += std::string("BIN\0", 4) + bytes_;
    report_.bytes = glb.size();
    return glb;
  }

  const GltfReport& report() const { return report_; }

 private:
  template <class T>
  static void append(std::string& to, const T& value) {
    to.append(reinterpret_cast<const char*>(&value), sizeof value);
  }

  std::size_t add_view(const void* data, std::size_t size, int target) {
    if (bytes_.size() + size > kMostBytes)
      throw Error(ErrorKind::kLimitExceeded, "export", "the meshes take more than 4 GiB",
                  "export fewer or smaller prototypes");
    doc_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}, {"target", target}});
    bytes_.append(static_cast<const char*>(data), size);
    return doc_["bufferViews"].size() - 1;
  }

  std::size_t add_positions(const std::vector<Vec3f>& p) {
    Vec3f lo = p.front(), hi = p.front();
    for (const Vec3f& each : p) {
      lo = glm::min(lo, each);
      hi = glm::max(hi, each);
    }
    doc_["accessors"].push_back({{"bufferView", add_view(p.data(), p.size() * sizeof(Vec3f), kArrayBuffer)},
                                 {"componentType", kFloat},
                                 {"count", p.size()},
                                 {"type", "VEC3"},
                                 {"min", {lo.x, lo.y, lo.z}},
                                 {"max", {hi.x, hi.y, hi.z}}});
    return doc_["accessors"].size() - 1;
  }

  std::size_t add_corners(const std::vector<std::uint32_t>& corners) {
    doc_["accessors"].push_back(
        {{"bufferView",
          add_view(corners.data(), corners.size() * sizeof(std::uint32_t), kElementArrayBuffer)},
         {"componentType", kUnsignedInt},
         {"count", corners.size()},
         {"type", "SCALAR"}});
    return doc_["accessors"].size() - 1;
  }

  // Green or brown as bright as the species in PAR: shares of red, green and blue of typical leaves and bark.
  json colour(const std::string& name, bool is_wood) const {
    double reflectance = is_wood ? 0.15 : 0.08;
    for (const Material& m : forest_.materials)
      for (const MaterialBand& band : m.bands)
        if (m.name == name && band.band == "PAR")
          reflectance = is_wood ? band.bark_reflectance : band.leaf_reflectance;
    const Vec3 shares = is_wood ? Vec3(1.25, 0.95, 0.7) : Vec3(0.75, 1.5, 0.3);
    const Vec3 c = glm::min(reflectance * shares, Vec3(1));
    return {c.x, c.y, c.z, 1};
  }

  std::size_t material(const Prototype& prototype, const GltfPrimitive& p) {
    const std::string name = face_material_name(prototype, p.part, p.material);
    json& all = doc_["materials"];
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i]["name"] == name) return i;
    all.push_back(
        {{"name", name},
         {"doubleSided", true},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", colour(prototype.materials.at(p.material), p.part == PlantPart::kWood)},
           {"metallicFactor", 0},
           {"roughnessFactor", 0.8}}}});
    return all.size() - 1;
  }

  // The trees, then the root, turned by -90 degrees about x: our (x, y, z) is glTF's (x, z, -y).
  void finish_nodes() {
    json children = json::array();
    for (std::size_t i = 0; i < trees_.size(); ++i) children.push_back(i);
    const double half = std::sqrt(0.5);
    trees_.push_back({{"name", forest_.name.empty() ? "forest" : forest_.name},
                      {"rotation", {-half, 0, 0, half}},
                      {"children", std::move(children)}});
    doc_["scenes"] = json::array({{{"nodes", {trees_.size() - 1}}}});
    doc_["nodes"] = std::move(trees_);
  }

  const Forest& forest_;
  json doc_, trees_ = json::array();
  std::string bytes_;
  GltfReport report_;
};

void require_possible(const Forest& forest) {
  validate(forest);
  if (forest.instances.empty()) throw_invalid("export", "the forest has no trees", "grow or import some");
  if (forest.instances.size() > kMostInstances)
    throw Error(ErrorKind::kLimitExceeded, "export",
                std::to_string(forest.instances.size()) + " trees are more nodes than viewers open",
                "at most 1000000: export a part of the forest");
}

}  // namespace

GltfReport export_gltf(const Forest& forest, const std::filesystem::path& path, const RunControl& control) {
  require_possible(forest);
  GlbWriter writer(forest);
  std::vector<bool> used(forest.prototypes.size(), false);
  for (const Instance& i : forest.instances) used[i.prototype.value] = true;
  std::vector<std::optional<std::size_t>> meshes(forest.prototypes.size());
  for (std::size_t p = 0; p < meshes.size(); ++p) {
    control.check();
    if (used[p]) meshes[p] = writer.add_mesh(forest.prototypes[p]);
  }
  for (const Instance& i : forest.instances)
    if (const auto mesh = meshes[i.prototype.value]) writer.add_node(i, *mesh);
  if (writer.report().nodes == 0)
    throw_invalid("export", "no tree has leaves or wood", "grow or import some");
  write_whole_file(path, writer.file());
  return writer.report();
}

}  // namespace sunfleck
