// GeoTIFFs: their bytes are where the format wants them, the ground map lies where it should with north up,
// and GDAL reads the same numbers, names and place.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "lighting/map/ground_geotiff.h"
#include "sim/base/error.h"
#include "tests/lighting/map/example_study.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

GeoRaster small_raster() {
  GeoRaster raster{3, 2, {100, 250}, {2, 5}, 0, {}};
  raster.bands = {{"first & <best>", "a \"quoted\" thing", "1", {1, 2, 3, 4, 5, NAN}},
                  {"second", "another", "MJ m-2", {-1, 0, 1e10f, 0.5f, 0.25f, 7}}};
  return raster;
}

template <class T>
T at(const std::string& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

struct Field {
  std::uint16_t type = 0;
  std::uint32_t count = 0, value = 0;
};

// Of the first directory: TIFF 6.0, section 2.
Field field(const std::string& bytes, std::uint16_t tag) {
  const auto directory = at<std::uint32_t>(bytes, 4);
  const auto count = at<std::uint16_t>(bytes, directory);
  std::uint16_t last = 0;
  Field found;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t place = directory + 2 + 12 * k;
    const auto here = at<std::uint16_t>(bytes, place);
    EXPECT_GT(here, last) << "tags must rise";
    last = here;
    if (here == tag)
      found = {at<std::uint16_t>(bytes, place + 2), at<std::uint32_t>(bytes, place + 4),
               at<std::uint32_t>(bytes, place + 8)};
  }
  EXPECT_NE(found.count, 0u) << tag;
  return found;
}

TEST(GeoTiff, HoldsItsCellsAndItsPlaceWhereTheFormatWantsThem) {
  const fs::path path = test::scratch_dir() / "small.tif";
  const GeoRaster raster = small_raster();
  save_geotiff(raster, path);
  const std::string bytes = content(path);
  EXPECT_EQ(bytes.substr(0, 4), std::string("II*\0", 4));
  EXPECT_EQ(field(bytes, 256).value, 3u);
  EXPECT_EQ(field(bytes, 257).value, 2u);
  EXPECT_EQ(field(bytes, 277).value & 0xffffu, 2u);
  const Field strips = field(bytes, 273);
  ASSERT_EQ(strips.count, 2u);
  for (std::size_t b = 0; b < 2; ++b) {
    const auto strip = at<std::uint32_t>(bytes, strips.value + 4 * b);
    ASSERT_LE(strip + 24, bytes.size());
    EXPECT_EQ(std::memcmp(bytes.data() + strip, raster.bands[b].value.data(), 24), 0);
  }
  const Field scale = field(bytes, 33550), tie = field(bytes, 33922), keys = field(bytes, 34735);
  EXPECT_EQ(at<double>(bytes, scale.value), 2);
  EXPECT_EQ(at<double>(bytes, scale.value + 8), 5);
  EXPECT_EQ(at<double>(bytes, tie.value + 24), 100);
  EXPECT_EQ(at<double>(bytes, tie.value + 32), 250);
  EXPECT_EQ(keys.count, 4u + 4 * at<std::uint16_t>(bytes, keys.value + 6));
  save_geotiff(raster, test::scratch_dir() / "again.tif");
  EXPECT_EQ(content(test::scratch_dir() / "again.tif"), bytes);
}

TEST(GeoTiff, RefusesWhatIsNoRaster) {
  const fs::path path = test::scratch_dir() / "never.tif";
  GeoRaster raster = small_raster();
  EXPECT_THROW(save_geotiff(raster, test::scratch_dir() / "a.png"), Error);
  raster.bands[1].value.pop_back();
  EXPECT_THROW(save_geotiff(raster, path), Error);
  raster = small_raster();
  raster.epsg = 99999;
  EXPECT_THROW(save_geotiff(raster, path), Error);
  raster = small_raster();
  raster.bands.clear();
  EXPECT_THROW(save_geotiff(raster, path), Error);
  EXPECT_FALSE(fs::exists(path));
}

// The cell under a point of the map is the pixel under it, rows counted from the north.
TEST(GroundGeoTiff, HasNorthAtTheTop) {
  const StandTables& t = test::example_study().tables;
  const GeoRaster raster = ground_raster(t, 32632);
  EXPECT_EQ(raster.epsg, 32632);
  EXPECT_EQ(raster.north_west_m, Vec2(0, 18));
  EXPECT_EQ(raster.cell_m, Vec2(4.5, 4.5));
  const StandVariable& pacl = *t.find(StandTarget::kGround, "pacl_total");
  const auto band = std::find_if(raster.bands.begin(), raster.bands.end(),
                                 [](const GeoTiffBand& b) { return b.name == "pacl_total"; });
  ASSERT_NE(band, raster.bands.end());
  for (const Vec2 point : {Vec2(1, 1), Vec2(17, 2), Vec2(3, 16), Vec2(10, 12)}) {
    const auto row = static_cast<std::size_t>((18 - point.y) / 4.5);
    const auto column = static_cast<std::size_t>(point.x / 4.5);
    EXPECT_EQ(band->value[row * raster.columns + column],
              static_cast<float>(pacl.value[t.map.cell_at(point.x, point.y)]));
  }
  EXPECT_EQ(raster.bands.back().name, "pacl_total " + t.intervals.back());
}

struct Ran {
  int code = -1;
  std::string text;
};
Ran run(const std::string& command) {
  Ran ran;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer;
  for (std::size_t n; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    ran.text.append(buffer.data(), n);
  ran.code = pclose(pipe);
  return ran;
}

TEST(GroundGeoTiff, GdalReadsIt) {
  if (run("gdalinfo --version").code != 0) {
    std::fprintf(stderr, "\n*** SKIPPED: gdalinfo is not here; the GeoTIFF was not opened by GDAL ***\n\n");
    GTEST_SKIP();
  }
  const fs::path plain = test::scratch_dir() / "small.tif", ground = test::scratch_dir() / "ground.tif";
  save_geotiff(small_raster(), plain);
  const Ran local = run("gdalinfo '" + plain.string() + "'");
  EXPECT_EQ(local.code, 0) << local.text;
  EXPECT_EQ(local.text.find("Warning"), std::string::npos) << local.text;
  for (const char* text : {"Size is 3, 2", "Origin = (100.000000000000000,250.000000000000000)",
                           "Pixel Size = (2.000000000000000,-5.000000000000000)", "Local plane coordinates",
                           "Description = first & <best>", "long_name=a \"quoted\" thing",
                           "Unit Type: MJ m-2", "NoData Value=nan", "Type=Float32"})
    EXPECT_NE(local.text.find(text), std::string::npos) << text << "\n" << local.text;
  // Column 1, row 1 of both bands.
  const Ran value = run("gdallocationinfo -valonly '" + plain.string() + "' 1 1");
  EXPECT_EQ(value.text, "5\n0.25\n");

  const StandTables& t = test::example_study().tables;
  save_ground_geotiff(t, 32632, ground);
  const Ran info = run("gdalinfo '" + ground.string() + "'");
  EXPECT_NE(info.text.find("UTM zone 32N"), std::string::npos) << info.text;
  EXPECT_NE(info.text.find("Description = pacl_total"), std::string::npos) << info.text;
  const Ran there = run("gdallocationinfo -valonly -geoloc -b 1 '" + ground.string() + "' 10 12");
  const StandVariable& first = t.find(StandTarget::kGround)->variables.front();
  EXPECT_NEAR(std::stod(there.text), first.value[t.map.cell_at(10, 12)], 1e-6) << there.text;
}

}  // namespace
}  // namespace sunfleck
