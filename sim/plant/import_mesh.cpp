// A mesh becomes leaves and wood by the names of its materials.
#include <algorithm>
#include <cctype>
#include <optional>

#include "sim/base/error.h"
#include "sim/plant/flat_elements.h"
#include "sim/plant/raw_mesh.h"
#include "sim/plant/text_file.h"

namespace sunfleck {
namespace {

enum class Use { kLeaf, kWood };
struct MaterialUse {
  Use use;
  std::uint16_t material;  // index into Prototype::materials
};

void require_disjoint(const MeshMaterials& materials) {
  for (const auto& [name, forest_material] : materials.leaf_materials)
    if (materials.wood_materials.contains(name))
      throw_invalid("material \"" + name + "\"", "is given as leaf and as wood", "choose one");
}

std::string names_of(const MeshMaterials& materials) {
  std::string all;
  for (const auto* each : {&materials.leaf_materials, &materials.wood_materials})
    for (const auto& [name, forest_material] : *each) all += (all.empty() ? "\"" : ", \"") + name + "\"";
  return all.empty() ? "none" : all;
}

std::uint16_t index_of(const std::string& name, Prototype& prototype) {
  auto& all = prototype.materials;
  const auto found = std::find(all.begin(), all.end(), name);
  if (found != all.end()) return static_cast<std::uint16_t>(found - all.begin());
  all.push_back(name);
  return static_cast<std::uint16_t>(all.size() - 1);
}

// What the faces of each material of the mesh become; nothing for materials that are not named.
std::vector<std::optional<MaterialUse>> uses_of(const RawMesh& mesh, const MeshMaterials& materials,
                                                Prototype& prototype) {
  std::vector<std::optional<MaterialUse>> uses;
  for (const std::string& name : mesh.materials) {
    const auto leaf = materials.leaf_materials.find(name), wood = materials.wood_materials.find(name);
    if (leaf != materials.leaf_materials.end())
      uses.push_back(MaterialUse{Use::kLeaf, index_of(leaf->second, prototype)});
    else if (wood != materials.wood_materials.end())
      uses.push_back(MaterialUse{Use::kWood, index_of(wood->second, prototype)});
    else
      uses.emplace_back();
  }
  return uses;
}

RawMesh read_mesh(const std::filesystem::path& path) {
  std::string kind = path.extension() == ".gz" ? path.stem().extension().string() : path.extension().string();
  std::transform(kind.begin(), kind.end(), kind.begin(), [](unsigned char c) { return std::tolower(c); });
  if (kind == ".obj") return parse_obj(read_text_file(path), path.string());
  if (kind == ".ply") return parse_ply(read_text_file(path), path.string());
  throw_invalid(path.string(), "is no mesh format that is read", "give a file *.obj or *.ply (or these .gz)");
}

void add_face(const RawMesh& mesh, const RawMesh::Face& face, const MaterialUse& use, Prototype& prototype,
              ImportReport& report) {
  std::vector<Vec3> corners_m;
  for (std::size_t i = 0; i < face.count; ++i)
    corners_m.push_back(mesh.vertices_m[mesh.corners[face.first + i]]);
  if (use.use == Use::kLeaf)
    add_leaf_polygon(corners_m, use.material, prototype.foliage, report);
  else
    add_wood_polygon(corners_m, use.material, prototype.wood_mesh, report);
}

}  // namespace

Prototype import_mesh(const std::filesystem::path& path, const MeshMaterials& materials,
                      ImportReport* report) {
  require_disjoint(materials);
  const RawMesh mesh = read_mesh(path);
  Prototype prototype;
  prototype.name = path.filename().string();
  const auto uses = uses_of(mesh, materials, prototype);
  ImportReport found;
  for (const RawMesh::Face& face : mesh.faces) {
    if (!uses[face.material])
      throw_invalid(path.string() + mesh.face_place + std::to_string(face.line),
                    "material \"" + mesh.materials[face.material] + "\" is neither leaf nor wood",
                    "say which; given are " + names_of(materials));
    add_face(mesh, face, *uses[face.material], prototype, found);
  }
  finish_import(path.string(), prototype, found);
  if (report) *report = std::move(found);
  return prototype;
}

}  // namespace sunfleck
