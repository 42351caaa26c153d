// NetCDF files: every bit comes back, equal runs give equal variables, what ncdump prints is what the format
// promises, and each unreadable or unwritable path is named with what would be right.
#include <gtest/gtest.h>
#include <netcdf.h>

#include <bit>
#include <chrono>
#include <fstream>

#include "lighting/map/light_map_file.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "tests/lighting/map/example_map.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

namespace fs = std::filesystem;
using test::example_forest;
using test::example_map;

bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

void expect_same(const FaceLight& a, const FaceLight& b) {
  ASSERT_TRUE(same_bits(a.direct_w_m2, b.direct_w_m2));
  ASSERT_TRUE(same_bits(a.sky_w_m2, b.sky_w_m2));
  ASSERT_TRUE(same_bits(a.scattered_w_m2, b.scattered_w_m2));
}

void expect_same(const TreeLight& a, const TreeLight& b) {
  EXPECT_EQ(a.tree, b.tree);
  EXPECT_EQ(a.instance, b.instance);
  EXPECT_EQ(a.leaf_area_m2, b.leaf_area_m2);
  EXPECT_EQ(a.sunlit_leaf_area_m2, b.sunlit_leaf_area_m2);
  EXPECT_EQ(a.absorbed_w, b.absorbed_w);
  EXPECT_EQ(a.absorbed_standard_error_w, b.absorbed_standard_error_w);
  EXPECT_EQ(a.mean_irradiance_w_m2, b.mean_irradiance_w_m2);
}

void expect_same(const EnergyBudget& a, const EnergyBudget& b) {
  EXPECT_EQ(a.incident_w, b.incident_w);
  EXPECT_EQ(a.absorbed_foliage_w, b.absorbed_foliage_w);
  EXPECT_EQ(a.absorbed_wood_w, b.absorbed_wood_w);
  EXPECT_EQ(a.absorbed_ground_w, b.absorbed_ground_w);
  EXPECT_EQ(a.escaped_w, b.escaped_w);
  EXPECT_EQ(a.residual_w, b.residual_w);
  EXPECT_EQ(a.residual_standard_error_w, b.residual_standard_error_w);
}

void expect_same(const BandLightMap& a, const BandLightMap& b) {
  EXPECT_EQ(a.band, b.band);
  ASSERT_EQ(a.elements.size(), b.elements.size());
  for (std::size_t i = 0; i < a.elements.size(); ++i) {
    expect_same(a.elements[i].front, b.elements[i].front);
    expect_same(a.elements[i].back, b.elements[i].back);
    ASSERT_TRUE(same_bits(a.elements[i].absorbed_w, b.elements[i].absorbed_w));
  }
  EXPECT_EQ(a.standard_error_w_m2, b.standard_error_w_m2);
  ASSERT_EQ(a.trees.size(), b.trees.size());
  for (std::size_t t = 0; t < a.trees.size(); ++t) expect_same(a.trees[t], b.trees[t]);
  expect_same(a.budget, b.budget);
  EXPECT_EQ(a.has_budget, b.has_budget);
  EXPECT_EQ(a.mean_irradiance_w_m2, b.mean_irradiance_w_m2);
  EXPECT_EQ(a.mean_irradiance_standard_error_w_m2, b.mean_irradiance_standard_error_w_m2);
}

void expect_same(const Provenance& a, const Provenance& b) {
  EXPECT_EQ(a.method, b.method);
  EXPECT_EQ(a.version, b.version);
  EXPECT_EQ(a.forest_hash, b.forest_hash);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(a.settings, b.settings);
  EXPECT_EQ(a.notes, b.notes);
  ASSERT_EQ(a.skipped.size(), b.skipped.size());
  for (std::size_t i = 0; i < a.skipped.size(); ++i) {
    EXPECT_EQ(a.skipped[i].what, b.skipped[i].what);
    EXPECT_EQ(a.skipped[i].reason, b.skipped[i].reason);
    EXPECT_EQ(a.skipped[i].relative_bound, b.skipped[i].relative_bound);
  }
  ASSERT_EQ(a.times.size(), b.times.size());
  for (std::size_t i = 0; i < a.times.size(); ++i) {
    EXPECT_EQ(a.times[i].stage, b.times[i].stage);
    EXPECT_EQ(a.times[i].wall_s, b.times[i].wall_s);
    EXPECT_EQ(a.times[i].cpu_s, b.times[i].cpu_s);
  }
}

void expect_same(const LightMap& a, const LightMap& b) {
  EXPECT_EQ(a.sunlit_fraction, b.sunlit_fraction);
  ASSERT_EQ(a.bands.size(), b.bands.size());
  for (std::size_t i = 0; i < a.bands.size(); ++i) expect_same(a.bands[i], b.bands[i]);
  expect_same(a.provenance, b.provenance);
}

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), {}));
}

Error error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no Error was thrown";
  return {ErrorKind::kCancelled, "", ""};
}

// Reads one value by name with the plain C interface, as any other program would.
class Reader {
 public:
  explicit Reader(const fs::path& path) { EXPECT_EQ(nc_open(path.c_str(), NC_NOWRITE, &id_), NC_NOERR); }
  ~Reader() { nc_close(id_); }
  double value(const char* name, std::vector<std::size_t> at) const {
    int variable = 0;
    double number = 0;
    EXPECT_EQ(nc_inq_varid(id_, name, &variable), NC_NOERR) << name;
    EXPECT_EQ(nc_get_var1_double(id_, variable, at.data(), &number), NC_NOERR) << name;
    return number;
  }
  std::string text(const char* variable_name, const char* attribute) const {
    int variable = NC_GLOBAL;
    if (*variable_name) {
      EXPECT_EQ(nc_inq_varid(id_, variable_name, &variable), NC_NOERR) << variable_name;
    }
    std::size_t length = 0;
    EXPECT_EQ(nc_inq_attlen(id_, variable, attribute, &length), NC_NOERR) << variable_name << attribute;
    std::string value(length, ' ');
    EXPECT_EQ(nc_get_att_text(id_, variable, attribute, value.data()), NC_NOERR);
    return value;
  }
  int variables() const {
    int count = 0;
    nc_inq_nvars(id_, &count);
    return count;
  }
  std::string name(int variable) const {
    char text[NC_MAX_NAME + 1] = {};
    nc_inq_varname(id_, variable, text);
    return text;
  }

 private:
  int id_ = 0;
};

// 70,000 elements per tree cross the border of a chunk; ids above 2^31 and a coordinate of 1e5/3 m ask for
// the full width of their types.
TEST(NetCdf, EveryBitComesBack) {
  const Forest forest = example_forest(2, 35001);
  const LightMap map = example_map(forest);
  const fs::path path = test::scratch_dir() / "map.nc";
  save_netcdf(map, forest, path);
  expect_same(map, load_netcdf(path));
}

TEST(NetCdf, AnEmptyForestComesBack) {
  const Forest forest = example_forest(0, 3);
  const LightMap map = example_map(forest);
  const fs::path path = test::scratch_dir() / "empty.nc";
  save_netcdf(map, forest, path);
  expect_same(map, load_netcdf(path));
}

TEST(NetCdf, OtherProgramsFindPlacesAreasAndUnits) {
  const Forest forest = example_forest(2, 5);
  const LightMap map = example_map(forest);
  const fs::path path = test::scratch_dir() / "places.nc";
  save_netcdf(map, forest, path);
  const Reader file(path);
  const WorldElement element = world_element(forest, 1, 2);  // element 5 + 2
  EXPECT_EQ(file.value("x", {7}), element.centre_m.x);
  EXPECT_EQ(file.value("y", {7}), element.centre_m.y);
  EXPECT_EQ(file.value("z", {7}), element.centre_m.z);
  EXPECT_EQ(file.value("area", {7}), element.area_m2);
  EXPECT_EQ(file.value("normal_z", {7}), 1.0);  // leaves of the example are level
  EXPECT_EQ(file.value("tree_id", {7}), 4000000001.0);
  EXPECT_EQ(file.value("instance", {7}), 1.0);
  EXPECT_EQ(file.value("prototype_element", {7}), 2.0);
  EXPECT_EQ(file.value("irradiance_back_sky", {1, 7}), double{map.bands[1].elements[7].back.sky_w_m2});
  EXPECT_EQ(file.value("tree_x", {1}), 7.1);
  EXPECT_EQ(file.text("", "Conventions").substr(0, 3), "CF-");
  EXPECT_EQ(file.text("", "forest_hash"), "abc123");
  EXPECT_EQ(file.text("absorbed", "units"), "W");
  EXPECT_EQ(file.text("irradiance_back_sky", "units"), "W m-2");
  EXPECT_EQ(file.text("irradiance_back_sky", "coordinates"), "x y z band_name");
}

TEST(NetCdf, EveryVariableHasADescription) {
  const Forest forest = example_forest(1, 2);
  const fs::path path = test::scratch_dir() / "described.nc";
  save_netcdf(example_map(forest), forest, path);
  const Reader file(path);
  EXPECT_GT(file.variables(), 30);
  for (int v = 0; v < file.variables(); ++v)
    EXPECT_GT(file.text(file.name(v).c_str(), "long_name").size(), 5u) << file.name(v);
}

TEST(NetCdf, WithoutStandardErrorsThereIsNoSuchVariable) {
  const Forest forest = example_forest(1, 2);
  LightMap map = example_map(forest);
  map.bands[0].standard_error_w_m2.clear();
  const fs::path path = test::scratch_dir() / "no_error.nc";
  save_netcdf(map, forest, path);
  const Reader file(path);
  for (int v = 0; v < file.variables(); ++v) EXPECT_NE(file.name(v), "irradiance_standard_error");
  EXPECT_TRUE(load_netcdf(path).bands[0].standard_error_w_m2.empty());
}

TEST(NetCdf, EqualMapsGiveEqualBytes) {
  const Forest forest = example_forest(2, 1000);
  const fs::path a = test::scratch_dir() / "a.nc", b = test::scratch_dir() / "b.nc";
  save_netcdf(example_map(forest), forest, a);
  save_netcdf(example_map(forest), forest, b);
  EXPECT_EQ(bytes_of(a), bytes_of(b));
}

TEST(NetCdf, APathThatCannotBeWrittenIsNamedAndNothingIsLeft) {
  const Forest forest = example_forest(1, 2);
  const LightMap map = example_map(forest);
  const fs::path folder = test::scratch_dir() / "unwritable";
  fs::create_directories(folder / "taken.nc");
  for (const char* name : {"taken.nc", "missing_folder/map.nc", "missing_folder/"}) {
    const fs::path path = folder / name;
    const Error error = error_of([&] { save_netcdf(map, forest, path); });
    EXPECT_EQ(error.kind(), ErrorKind::kInputOutput) << name;
    EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
    EXPECT_FALSE(error.remedy().empty());
  }
  EXPECT_EQ(files_in(folder), 1u);
}

TEST(NetCdf, AFailureLeavesTheOldFileAlone) {
  const Forest forest = example_forest(1, 2);
  const fs::path folder = test::scratch_dir() / "kept";
  fs::create_directories(folder);
  save_netcdf(example_map(forest), forest, folder / "map.nc");
  const std::string before = bytes_of(folder / "map.nc");
  LightMap broken = example_map(forest);
  broken.bands[1].elements[1].back.sky_w_m2 = NAN;
  EXPECT_THROW(save_netcdf(broken, forest, folder / "map.nc"), ContractViolation);
  EXPECT_EQ(bytes_of(folder / "map.nc"), before);
  EXPECT_EQ(files_in(folder), 1u);
}

TEST(NetCdf, AMapOfAnotherForestIsRefused) {
  const LightMap map = example_map(example_forest(1, 2));
  const Error error =
      error_of([&] { save_netcdf(map, example_forest(1, 3), test::scratch_dir() / "other.nc"); });
  EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput);
  EXPECT_NE(std::string(error.what()).find("2 elements"), std::string::npos) << error.what();
}

struct BadFile {
  const char* name;
  ErrorKind kind;
  const char* says;
  std::function<void(const fs::path&)> make;
};

void write_foreign_netcdf(const fs::path& path) {
  int id = 0, dimension = 0;
  ASSERT_EQ(nc_create(path.c_str(), NC_NETCDF4, &id), NC_NOERR);
  ASSERT_EQ(nc_def_dim(id, "band", 2, &dimension), NC_NOERR);
  nc_close(id);
}

void write_our_mark_only(const fs::path& path) {
  int id = 0;
  ASSERT_EQ(nc_create(path.c_str(), NC_NETCDF4, &id), NC_NOERR);
  ASSERT_EQ(nc_put_att_text(id, NC_GLOBAL, "sunfleck_format", 11, "light map 1"), NC_NOERR);
  nc_close(id);
}

void write_newer_format(const fs::path& path) {
  int id = 0;
  ASSERT_EQ(nc_create(path.c_str(), NC_NETCDF4, &id), NC_NOERR);
  ASSERT_EQ(nc_put_att_text(id, NC_GLOBAL, "sunfleck_format", 11, "light map 9"), NC_NOERR);
  nc_close(id);
}

void write_half_a_map(const fs::path& path) {
  const Forest forest = example_forest(2, 500);
  save_netcdf(example_map(forest), forest, path);
  fs::resize_file(path, fs::file_size(path) / 2);
}

TEST(NetCdf, UnreadableFilesAreNamedWithWhatIsWrong) {
  const BadFile table[] = {
      {"missing.nc", ErrorKind::kNotFound, "no such file", [](const fs::path&) {}},
      {"text.nc", ErrorKind::kInvalidInput, "not a whole NetCDF file",
       [](const fs::path& path) { std::ofstream(path) << "element,tree_id\n"; }},
      {"nothing.nc", ErrorKind::kInvalidInput, "not a whole NetCDF file",
       [](const fs::path& path) { std::ofstream(path).flush(); }},
      {"half.nc", ErrorKind::kInvalidInput, "not a whole NetCDF file", write_half_a_map},
      {"folder.nc", ErrorKind::kInvalidInput, "not a whole NetCDF file",
       [](const fs::path& path) { fs::create_directory(path); }},
      {"foreign.nc", ErrorKind::kInvalidInput, "not a light map", write_foreign_netcdf},
      {"mark.nc", ErrorKind::kInvalidInput, "attribute method", write_our_mark_only},
      {"newer.nc", ErrorKind::kInvalidInput, "light map 9", write_newer_format},
  };
  for (const BadFile& bad : table) {
    const fs::path path = test::scratch_dir() / bad.name;
    bad.make(path);
    const Error error = error_of([&] { load_netcdf(path); });
    EXPECT_EQ(error.kind(), bad.kind) << bad.name;
    EXPECT_EQ(error.where(), path.string());
    EXPECT_NE(std::string(error.what()).find(bad.says), std::string::npos) << error.what();
    EXPECT_FALSE(error.remedy().empty()) << bad.name;
  }
}

// A million elements in two bands: about 100 MB of numbers. The bound is loose for shared machines and slow
// builds; the measured time is printed.
TEST(NetCdf, AMillionElementsTakeSeconds) {
  const Forest forest = example_forest(10, 100000);
  const LightMap map = example_map(forest);
  const fs::path path = test::scratch_dir() / "million.nc";
  const auto start = std::chrono::steady_clock::now();
  save_netcdf(map, forest, path);
  const auto saved = std::chrono::steady_clock::now();
  const LightMap loaded = load_netcdf(path);
  const auto end = std::chrono::steady_clock::now();
  const double save_s = std::chrono::duration<double>(saved - start).count();
  const double load_s = std::chrono::duration<double>(end - saved).count();
  std::printf("NetCDF, 1e6 elements x 2 bands: save %.2f s, load %.2f s, %.0f MB\n", save_s, load_s,
              static_cast<double>(fs::file_size(path)) * 1e-6);
  EXPECT_EQ(loaded.bands[1].elements.size(), 1000000u);
  EXPECT_LT(save_s, 60.0);
}

}  // namespace
}  // namespace sunfleck
