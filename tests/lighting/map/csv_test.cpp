// CSV files: header with units, numbers that read back to the same bits, no NaN, fast.
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <sstream>

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

std::vector<std::string> lines_of(const fs::path& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

// Splits at commas; a name in quotes is one field.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  bool inside = false;
  for (const char c : line) {
    if (c == '"') inside = !inside;
    if (c == ',' && !inside)
      fields.emplace_back();
    else
      fields.back() += c;
  }
  return fields;
}

TEST(ElementCsv, NumbersReadBackExactly) {
  const Forest forest = example_forest(2, 20);
  const LightMap map = example_map(forest);
  const fs::path path = test::scratch_dir() / "elements.csv";
  save_element_csv(map, forest, path);
  const auto lines = lines_of(path);
  ASSERT_EQ(lines.size(), 1u + 2 * 40);
  EXPECT_EQ(lines[0],
            "element,tree_id,x_m,y_m,z_m,area_m2,band,front_direct_w_m2,front_sky_w_m2,"
            "front_scattered_w_m2,back_direct_w_m2,back_sky_w_m2,back_scattered_w_m2,absorbed_w,"
            "sunlit_fraction,standard_error_w_m2");
  const auto par = fields_of(lines[1 + 2 * 23]), nir = fields_of(lines[2 + 2 * 23]);
  ASSERT_EQ(par.size(), 16u);
  ASSERT_EQ(nir.size(), 16u);
  const WorldElement element = world_element(forest, 1, 3);  // element 23
  EXPECT_EQ(par[0], "23");
  EXPECT_EQ(par[1], "4000000001");
  EXPECT_EQ(std::stod(par[2]), element.centre_m.x);
  EXPECT_EQ(std::stod(par[3]), element.centre_m.y);
  EXPECT_EQ(std::stod(par[4]), element.centre_m.z);
  EXPECT_EQ(std::stod(par[5]), element.area_m2);
  EXPECT_EQ(par[6], "PAR");
  EXPECT_EQ(nir[6], "\"NIR, near\"");
  const ElementLight& light = map.bands[1].elements[23];
  const float expected[] = {light.front.direct_w_m2, light.front.sky_w_m2,   light.front.scattered_w_m2,
                            light.back.direct_w_m2,  light.back.sky_w_m2,    light.back.scattered_w_m2,
                            light.absorbed_w,        map.sunlit_fraction[23]};
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(std::stof(nir[7 + i]), expected[i]) << i;
  EXPECT_EQ(std::stof(par[15]), map.bands[0].standard_error_w_m2[23]);
  EXPECT_EQ(nir[15], "");  // the method gave none in this band
}

TEST(TreeCsv, OneLinePerTreeAndBand) {
  const Forest forest = example_forest(2, 3);
  const LightMap map = example_map(forest);
  const fs::path path = test::scratch_dir() / "trees.csv";
  save_tree_csv(map, forest, path);
  const auto lines = lines_of(path);
  ASSERT_EQ(lines.size(), 1u + 2 * 3);
  EXPECT_EQ(lines[0],
            "tree_id,instance,x_m,y_m,z_m,band,leaf_area_m2,sunlit_leaf_area_m2,absorbed_w,"
            "absorbed_standard_error_w,mean_irradiance_w_m2");
  const auto fields = fields_of(lines[3]);  // tree 1, PAR
  const TreeLight& tree = map.bands[0].trees[1];
  EXPECT_EQ(fields[0], "4000000001");
  EXPECT_EQ(fields[1], "1");
  EXPECT_EQ(std::stod(fields[2]), 7.1);
  EXPECT_EQ(fields[5], "PAR");
  EXPECT_EQ(std::stod(fields[6]), tree.leaf_area_m2);
  EXPECT_EQ(std::stod(fields[8]), tree.absorbed_w);
  EXPECT_EQ(std::stod(fields[10]), tree.mean_irradiance_w_m2);
}

TEST(ElementCsv, ANaNIsABrokenContractAndLeavesNoFile) {
  const Forest forest = example_forest(1, 5);
  LightMap map = example_map(forest);
  map.bands[0].elements[4].front.sky_w_m2 = NAN;
  const fs::path folder = test::scratch_dir() / "nan";
  fs::create_directories(folder);
  EXPECT_THROW(save_element_csv(map, forest, folder / "map.csv"), ContractViolation);
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST(Csv, UnwritablePathsAndOtherForestsAreRefused) {
  const Forest forest = example_forest(1, 5);
  const LightMap map = example_map(forest);
  const fs::path path = test::scratch_dir() / "no_such_folder" / "map.csv";
  for (const auto& save : {save_element_csv, save_tree_csv}) {
    try {
      save(map, forest, path);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInputOutput);
      EXPECT_EQ(error.where(), path.string());
    }
    try {
      save(map, example_forest(2, 4), test::scratch_dir() / "other.csv");
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput);
    }
  }
  EXPECT_FALSE(fs::exists(test::scratch_dir() / "other.csv"));
}

// A device that is always full fails in the middle; it is not a regular file and is left alone.
TEST(Csv, ADeviceIsNotReplaced) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this machine";
  const Forest forest = example_forest(1, 5);
  EXPECT_THROW(save_element_csv(example_map(forest), forest, "/dev/full"), Error);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(ElementCsv, EqualMapsGiveEqualBytes) {
  const Forest forest = example_forest(2, 50);
  LightMap other = example_map(forest);
  other.provenance.times = {{"trace", 99, 99}};
  save_element_csv(example_map(forest), forest, test::scratch_dir() / "a.csv");
  save_element_csv(other, forest, test::scratch_dir() / "b.csv");
  EXPECT_EQ(lines_of(test::scratch_dir() / "a.csv"), lines_of(test::scratch_dir() / "b.csv"));
}

TEST(ElementCsv, AMillionLinesTakeSeconds) {
  const Forest forest = example_forest(5, 100000);
  const LightMap map = example_map(forest);
  const fs::path path = test::scratch_dir() / "million.csv";
  const auto start = std::chrono::steady_clock::now();
  save_element_csv(map, forest, path);
  const double save_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::printf("CSV, 1e6 lines: %.2f s, %.0f MB\n", save_s, static_cast<double>(fs::file_size(path)) * 1e-6);
  EXPECT_LT(save_s, 30.0);  // 3 s is the aim; loose for shared machines and slow builds
}

}  // namespace
}  // namespace sunfleck
