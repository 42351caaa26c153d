// The house rules of the tree: who may include whom, where heavy libraries may be seen, and what every folder
// is for.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>

#include "tests/support/golden.h"

namespace sunfleck {
namespace {

namespace fs = std::filesystem;

// Folder -> rank: a file may include its own folder and folders of lower rank only.
const std::map<std::string, int>& ranks() {
  static const std::map<std::string, int> table = {
      {"sim/base", 0},         {"sim/config", 1},         {"sim/lsystem", 1},      {"sim/plant", 2},
      {"sim/growth", 3},       {"sim/forest", 4},         {"sim/exchange", 5},     {"sim/grid", 5},
      {"lighting/optics", 10}, {"lighting/sky", 10},      {"lighting/base", 11},   {"lighting/depth", 12},
      {"lighting/slab", 13},   {"lighting/envelope", 13}, {"lighting/shade", 12},  {"lighting/transport", 13},
      {"lighting/trace", 13},  {"lighting/links", 14},    {"lighting/canopy", 15}, {"lighting/plan", 15},
      {"lighting/study", 16},  {"lighting/map", 17},      {"lighting/render", 18}, {"lighting/bench", 19},
      {"lighting/report", 19}, {"server/convert", 20},    {"server/jobs", 21},     {"server/client", 22},
      {"server/handlers", 22}, {"server/net", 23},        {"server/apps", 24}};
  return table;
}

std::string folder_of(const std::string& path) {
  const std::size_t first = path.find('/');
  return path.substr(0, path.find('/', first + 1));
}

// Two headers of a higher folder that hold plain nouns only, and may be seen from below: a species carries
// the numbers of its material, and prototypes are what a forest is made of.
bool allowed_exception(const std::string& from, const std::string& included) {
  return from == "sim/plant" && included == "sim/forest/forest.h";
}

struct Include {
  fs::path file;       // relative to the project
  std::string target;  // as written
};

std::vector<Include> all_includes() {
  const std::regex pattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<Include> includes;
  for (const char* top : {"sim", "lighting", "server"})
    for (const auto& entry : fs::recursive_directory_iterator(test::source_dir() / top)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp") continue;
      std::ifstream in(entry.path());
      std::smatch match;
      for (std::string line; std::getline(in, line);)
        if (std::regex_search(line, match, pattern))
          includes.push_back({fs::relative(entry.path(), test::source_dir()), match[1]});
    }
  return includes;
}

bool starts_with_any(const std::string& text, const std::vector<std::string>& prefixes) {
  for (const std::string& p : prefixes)
    if (text.rfind(p, 0) == 0) return true;
  return false;
}

TEST(Layers, IncludesPointDownwards) {
  const auto includes = all_includes();
  ASSERT_GT(includes.size(), 300u);  // the walk really found the sources
  for (const Include& i : includes) {
    if (!starts_with_any(i.target, {"sim/", "lighting/", "server/"})) continue;
    const std::string from = folder_of(i.file.generic_string()), to = folder_of(i.target);
    if (to == "sim/base" || from == to || allowed_exception(from, i.target)) continue;
    ASSERT_TRUE(ranks().contains(from)) << "unknown folder " << from;
    ASSERT_TRUE(ranks().contains(to)) << "unknown folder " << to << " in " << i.file;
    EXPECT_LT(ranks().at(to), ranks().at(from)) << i.file << " includes " << i.target;
  }
}

TEST(Layers, HeavyLibrariesStayInTheirRoomsAndOutOfHeaders) {
  const std::map<std::string, std::vector<std::string>> rooms = {
      {"sim/grid", {"openvdb/", "nanovdb/"}},
      {"lighting/trace", {"embree"}},
      {"lighting/render", {"OpenImageIO/"}},
      {"server", {"grpcpp/", "grpc/", "google/protobuf/", "proto/sunfleck", "sunfleck/v1"}}};
  for (const Include& i : all_includes())
    for (const auto& [room, prefixes] : rooms) {
      if (!starts_with_any(i.target, prefixes)) continue;
      EXPECT_TRUE(starts_with_any(i.file.generic_string(), {room + "/"}))
          << i.file << " includes " << i.target;
      if (room != "server") {
        EXPECT_EQ(i.file.extension(), ".cpp") << i.file << " includes " << i.target;
      }
    }
}

// True if only files of its own folder include this header.
bool is_private(const std::string& header, const std::vector<Include>& includes) {
  for (const Include& i : includes)
    if (i.target == header && folder_of(i.file.generic_string()) != folder_of(header)) return false;
  return true;
}

TEST(Layers, OtherLibrariesStayOutOfPublicHeaders) {
  const auto includes = all_includes();
  for (const Include& i : includes) {
    const std::string file = i.file.generic_string();
    if (i.file.extension() != ".h" || starts_with_any(file, {"server/"})) continue;
    if (!starts_with_any(i.target,
                         {"tbb/", "toml++/", "CLI/", "spdlog/", "netcdf", "openssl/", "libnova/", "zlib"}))
      continue;
    EXPECT_TRUE(is_private(file, includes))
        << file << " includes " << i.target << " and is seen outside its folder";
  }
}

TEST(Layers, NoTopLevelFolderBeyondThePlan) {
  const std::set<std::string> plan = {"configs", "proto", "sim",   "lighting",
                                      "server",  "tests", "build", "out"};
  for (const auto& entry : fs::directory_iterator(test::source_dir())) {
    const std::string name = entry.path().filename().string();
    if (entry.is_directory() && name[0] != '.') {
      EXPECT_TRUE(plan.contains(name)) << name;
    }
  }
}

}  // namespace
}  // namespace sunfleck
