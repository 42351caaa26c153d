#include "lighting/render/billboard_export.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lighting/render/billboard_atlas.h"
#include "lighting/render/billboard_file.h"
#include "sim/base/error.h"
#include "sim/base/pending_file.h"

namespace sunfleck {
namespace {

using nlohmann::json;

void write_atlas(const BillboardAtlas& atlas, const Vec3& colour, const std::filesystem::path& path) {
  std::vector<std::uint8_t> rgba;
  rgba.reserve(4 * atlas.cover.size());
  const auto byte = [](double linear) {  // sRGB
    const double c = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(c, 0.0, 1.0)));
  };
  const std::array<std::uint8_t, 3> rgb{byte(colour.x), byte(colour.y), byte(colour.z)};
  for (const std::uint8_t cover : atlas.cover) rgba.insert(rgba.end(), {rgb[0], rgb[1], rgb[2], cover});
  PendingFile pending(path);
  const auto output = OIIO::ImageOutput::create("png");
  OIIO::ImageSpec spec(atlas.side_px, atlas.side_px, 4, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  if (!output || !output->open(pending.path().string(), spec) ||
      !output->write_image(OIIO::TypeDesc::UINT8, rgba.data()) || !output->close())
    throw Error(ErrorKind::kInputOutput, path.string(), "cannot be written", "a folder that can be written");
  pending.commit();
}

// Four corners of each plane: position, normal, place in the picture (v downwards).
struct Quads {
  std::vector<Vec3f> position, normal;
  std::vector<std::array<float, 2>> place;
  std::vector<std::uint32_t> corner;
};

Quads quads_of(const BillboardCloud& cloud, const BillboardAtlas& atlas) {
  Quads q;
  for (std::size_t k = 0; k < cloud.plane.size(); ++k) {
    const Billboard& b = cloud.plane[k];
    const AtlasPlace& p = atlas.place[k];
    const auto first = static_cast<std::uint32_t>(q.position.size());
    for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      q.position.emplace_back(b.corner_m + u * b.width_m * b.along_u + v * b.height_m * b.along_v);
      q.normal.emplace_back(b.normal);
      q.place.push_back({static_cast<float>(p.x + u * p.width) / static_cast<float>(atlas.side_px),
                         static_cast<float>(p.y + (1 - v) * p.height) / static_cast<float>(atlas.side_px)});
    }
    for (const std::uint32_t c : {0u, 1u, 2u, 0u, 2u, 3u}) q.corner.push_back(first + c);
  }
  return q;
}

json gltf_of(const Quads& q, const AlphaCutoff& cutoff, const std::string& name, std::string& bin) {
  json views = json::array(), accessors = json::array();
  const auto add = [&](const auto& values, int component, const char* type, std::size_t count, int target) {
    const std::size_t offset = bin.size(), size = values.size() * sizeof(values[0]);
    bin.append(reinterpret_cast<const char*>(values.data()), size);
    views.push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}, {"target", target}});
    accessors.push_back(
        {{"bufferView", views.size() - 1}, {"componentType", component}, {"count", count}, {"type", type}});
  };
  add(q.position, 5126, "VEC3", q.position.size(), 34962);
  Vec3f lo = q.position.front(), hi = lo;
  for (const Vec3f& p : q.position) lo = glm::min(lo, p), hi = glm::max(hi, p);
  accessors.back()["min"] = {lo.x, lo.y, lo.z};
  accessors.back()["max"] = {hi.x, hi.y, hi.z};
  add(q.normal, 5126, "VEC3", q.normal.size(), 34962);
  add(q.place, 5126, "VEC2", q.place.size(), 34962);
  add(q.corner, 5125, "SCALAR", q.corner.size(), 34963);
  const double half = std::sqrt(0.5);
  return {
      {"asset", {{"version", "2.0"}, {"generator", "sunfleck"}}},
      {"scene", 0},
      {"scenes", json::array({{{"nodes", {0}}}})},
      {"nodes", json::array({{{"name", name}, {"mesh", 0}, {"rotation", {-half, 0, 0, half}}}})},
      {"meshes",
       json::array(
           {{{"primitives", json::array({{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}},
                                          {"indices", 3},
                                          {"material", 0}}})}}})},
      {"materials",
       json::array(
           {{{"name", "leaves"},
             {"doubleSided", true},
             {"alphaMode", "MASK"},
             {"alphaCutoff", (cutoff.least - 0.5) / 255},
             {"pbrMetallicRoughness",
              {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0}, {"roughnessFactor", 0.8}}}}})},
      {"textures", json::array({{{"source", 0}, {"sampler", 0}}})},
      {"samplers",
       json::array({{{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 33071}, {"wrapT", 33071}}})},
      {"images", json::array({{{"uri", "billboards.png"}}})},
      {"buffers", json::array({{{"uri", "billboards.bin"}, {"byteLength", bin.size()}}})},
      {"bufferViews", std::move(views)},
      {"accessors", std::move(accessors)}};
}

// As bright as the species in PAR; shares of red, green and blue of typical leaves, as the glTF of whole
// forests.
Vec3 leaf_colour(const Forest& forest, const Prototype& prototype) {
  double reflectance = 0.08;
  const std::string& name = prototype.materials[prototype.foliage.front().material];
  for (const Material& m : forest.materials)
    for (const MaterialBand& band : m.bands)
      if (m.name == name && band.band == "PAR") reflectance = band.leaf_reflectance;
  return reflectance * Vec3(0.75, 1.5, 0.3);
}

}  // namespace

BillboardExport export_billboards(const Forest& forest, std::size_t prototype,
                                  const BillboardExportOptions& options, const std::filesystem::path& folder,
                                  const RunControl& control) {
  if (prototype >= forest.prototypes.size())
    throw_invalid("--prototype", "there is no prototype " + std::to_string(prototype),
                  "one of " + std::to_string(forest.prototypes.size()));
  if (options.atlas_px < 256 || options.atlas_px > 16384)
    throw_invalid("--atlas", "is " + std::to_string(options.atlas_px), "256 to 16384 texels");
  const Prototype& tree = forest.prototypes[prototype];
  const BillboardCloud cloud = build_billboard_cloud(tree, options.cloud, {}, control);
  const BillboardAtlas atlas = bake_atlas(cloud, options.atlas_px, control);
  const AlphaCutoff cutoff = keeping_cover(atlas);
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed)
    throw Error(ErrorKind::kInputOutput, folder.string(), "cannot be made", "a folder that can be written");
  write_atlas(atlas, leaf_colour(forest, tree), folder / "billboards.png");
  std::string bin, dat;
  const std::string gltf =
      gltf_of(quads_of(cloud, atlas), cutoff, tree.name.empty() ? "tree" : tree.name, bin).dump();
  write_whole_file(folder / "billboards.bin", bin);
  write_whole_file(folder / "billboards.gltf", gltf);
  const std::string about = cloud_file(cloud, dat).dump(1);
  write_whole_file(folder / "cloud.dat", dat);
  write_whole_file(folder / "cloud.json", about);
  return {cloud.plane.size(), tree.foliage.size(), atlas.texel_m,          (cutoff.least - 0.5) / 255,
          cutoff.kept,        dat.size(),          4 * atlas.cover.size(), gltf.size() + bin.size()};
}

}  // namespace sunfleck
