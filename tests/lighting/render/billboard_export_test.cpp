// Billboard clouds on disk: glTF by the letters of the specification, the picture's area, the cloud's bytes
// as the library has them, and the same bytes every time.
#include "lighting/render/billboard_export.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

using nlohmann::json;

std::filesystem::path folder(const char* name) {
  return std::filesystem::path(testing::TempDir()) / ("billboards_" + std::string(name));
}
std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream all;
  all << in.rdbuf();
  return all.str();
}
const Forest& crown() {
  static const Forest made = generated_crown({CrownKind::kSphere, 2000, 1, 3, 5});
  return made;
}
BillboardExportOptions options() {
  BillboardExportOptions o;
  o.cloud.clusters.planes = 40;
  o.atlas_px = 512;
  return o;
}

std::vector<std::uint8_t> read_rgba(const std::filesystem::path& path, int side) {
  OIIO::ImageSpec as_stored;
  as_stored.attribute("oiio:UnassociatedAlpha", 1);
  auto input = OIIO::ImageInput::open(path.string(), &as_stored);
  EXPECT_TRUE(input) << OIIO::geterror();
  EXPECT_EQ(input->spec().width, side);
  EXPECT_EQ(input->spec().height, side);
  EXPECT_EQ(input->spec().nchannels, 4);
  std::vector<std::uint8_t> rgba(4 * static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  input->read_image(0, 0, 0, 4, OIIO::TypeDesc::UINT8, rgba.data());
  return rgba;
}

template <class T>
std::vector<T> accessor(const json& doc, const std::string& bin, std::size_t k, int component,
                        const char* type) {
  const json& a = doc["accessors"][k];
  const json& view = doc["bufferViews"][a["bufferView"].get<std::size_t>()];
  EXPECT_EQ(a["componentType"], component);
  EXPECT_EQ(a["type"], type);
  std::vector<T> values(a["count"].get<std::size_t>());
  EXPECT_EQ(view["byteLength"].get<std::size_t>(), values.size() * sizeof(T));
  EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0u);
  EXPECT_LE(view["byteOffset"].get<std::size_t>() + values.size() * sizeof(T), bin.size());
  std::memcpy(values.data(), bin.data() + view["byteOffset"].get<std::size_t>(), values.size() * sizeof(T));
  return values;
}

TEST(BillboardExport, GltfHoldsThePlanesWithTheirPicture) {
  const auto to = folder("gltf");
  const BillboardExport made = export_billboards(crown(), 0, options(), to);
  const json doc = json::parse(bytes_of(to / "billboards.gltf"));
  const std::string bin = bytes_of(to / "billboards.bin");
  EXPECT_EQ(doc["asset"]["version"], "2.0");
  EXPECT_EQ(doc["buffers"][0]["byteLength"], bin.size());
  EXPECT_EQ(doc["materials"][0]["alphaMode"], "MASK");
  EXPECT_TRUE(doc["materials"][0]["doubleSided"]);
  EXPECT_TRUE(std::filesystem::exists(to / doc["images"][0]["uri"].get<std::string>()));
  const auto position = accessor<Vec3f>(doc, bin, 0, 5126, "VEC3");
  const auto normal = accessor<Vec3f>(doc, bin, 1, 5126, "VEC3");
  const auto place = accessor<std::array<float, 2>>(doc, bin, 2, 5126, "VEC2");
  const auto corner = accessor<std::uint32_t>(doc, bin, 3, 5125, "SCALAR");
  ASSERT_EQ(position.size(), 4 * made.planes);
  ASSERT_EQ(normal.size(), position.size());
  ASSERT_EQ(place.size(), position.size());
  ASSERT_EQ(corner.size(), 6 * made.planes);
  for (std::size_t t = 0; t + 2 < corner.size(); t += 3) {
    const Vec3 a(position.at(corner[t])), b(position.at(corner[t + 1])), c(position.at(corner[t + 2]));
    // Seen against the normal the corners run counter-clockwise.
    EXPECT_NEAR(glm::dot(glm::normalize(glm::cross(b - a, c - a)), Vec3(normal[corner[t]])), 1, 1e-5);
  }
  for (const auto& uv : place)
    for (const float x : uv) EXPECT_TRUE(x >= 0 && x <= 1);
}

// Area of texels above the cutoff, in metres, against the leaf area less what leaves of a plane cover of each
// other: at most the leaf area; the cutoff keeps the picture's own cover within a tenth (texels are a third
// of a leaf).
TEST(BillboardExport, TheCutoffKeepsTheArea) {
  const auto to = folder("area");
  const BillboardExport made = export_billboards(crown(), 0, options(), to);
  EXPECT_NEAR(made.cover_kept, 1, 0.1);
  const auto rgba = read_rgba(to / "billboards.png", 512);
  double above = 0, cover = 0;
  for (std::size_t p = 0; p < rgba.size(); p += 4) {
    above += rgba[p + 3] / 255.0 >= made.alpha_cutoff;
    cover += rgba[p + 3] / 255.0;
    ASSERT_EQ(rgba[p + 1], rgba[1]);  // one green, also where nothing is: no dark rims
  }
  EXPECT_NEAR(above / cover, made.cover_kept, 1e-9);
  const double area = cover * made.texel_m * made.texel_m, leaves = leaf_area_m2(crown().prototypes[0]);
  EXPECT_LT(area, 1.02 * leaves);
  EXPECT_GT(area, 0.6 * leaves);
}

TEST(BillboardExport, TheCloudIsWrittenBitByBit) {
  const auto to = folder("cloud");
  export_billboards(crown(), 0, options(), to);
  const BillboardCloud cloud = build_billboard_cloud(crown().prototypes[0], options().cloud);
  const json about = json::parse(bytes_of(to / "cloud.json"));
  const std::string dat = bytes_of(to / "cloud.dat");
  const auto expect_same = [&](const char* name, const auto& values) {
    const json& at = about[name];
    ASSERT_EQ(at["count"].get<std::size_t>(), values.size()) << name;
    ASSERT_EQ(at["bytes_each"].get<std::size_t>(), sizeof(values[0])) << name;
    ASSERT_LE(at["offset"].get<std::size_t>() + values.size() * sizeof(values[0]), dat.size()) << name;
    EXPECT_EQ(std::memcmp(dat.data() + at["offset"].get<std::size_t>(), values.data(),
                          values.size() * sizeof(values[0])),
              0)
        << name;
  };
  expect_same("cells", cloud.cell);
  expect_same("lists", cloud.list);
  expect_same("records", cloud.record);
  expect_same("leaves", cloud.leaf);
  expect_same("low_resolution", cloud.low_res);
  EXPECT_EQ(about["planes"].size(), cloud.plane.size());
  EXPECT_EQ(about["masks"]["count"], 4 * 64);
}

TEST(BillboardExport, SameBytesForAnyThreads) {
  with_threads(1, [] { export_billboards(crown(), 0, options(), folder("one")); });
  with_threads(3, [] { export_billboards(crown(), 0, options(), folder("three")); });
  for (const char* file : {"billboards.gltf", "billboards.bin", "billboards.png", "cloud.json", "cloud.dat"})
    EXPECT_EQ(bytes_of(folder("one") / file), bytes_of(folder("three") / file)) << file;
}

TEST(BillboardExport, RefusesWhatItCannotDo) {
  BillboardExportOptions small = options();
  small.atlas_px = 16;
  EXPECT_THROW(export_billboards(crown(), 0, small, folder("bad")), Error);
  EXPECT_THROW(export_billboards(crown(), 7, options(), folder("bad")), Error);
  EXPECT_THROW(export_billboards(crown(), 0, options(), "/proc/nowhere/billboards"), Error);
}

}  // namespace
}  // namespace sunfleck
