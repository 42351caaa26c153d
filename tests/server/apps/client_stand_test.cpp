// `sunfleck client stand` writes what `sunfleck stand` writes, byte by byte but for the times of computing;
// also where trees that nobody measured stand around the plot.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>

#include "lighting/map/stand_netcdf.h"
#include "tests/server/apps/run_program.h"
#include "tests/server/served.h"

namespace sunfleck {
namespace {

namespace fs = std::filesystem;

using test::Ran;
using test::run;
using test::write_file;

// "natural": similar trees around the plot, and everything else that makes a stand more like a real one.
std::string scene_with(const std::string& kind) {
  const std::string surroundings = kind == "natural" ? "similar" : kind;
  return "[forest]\n" + std::string(kind == "natural" ? "realism = \"natural\"\nelement_area_m2 = 1\n" : "") +
         R"(name = "four trees"
trees = "crown"
inventory = "four.csv"
plot_polygon = "plot.csv"
elements_per_tree = 50
[forest.surroundings]
kind = ")" +
         surroundings + R"("
[stand_light]
latitude_deg = 50
longitude_deg = 5
from = "2021-06-01T00:00+01:00"
to = "2021-08-01T00:00+01:00"
radiation = "radiation.csv"
sensors = "sensors.csv"
ground_cell_m = 5
rays_per_cell = 100
tree_relative_error = 0
sensor_sun_rays = 1
sensor_sky_rays = 2
patch_deg = 30
bin_deg = 30
)";
}

void write_tables() {
  write_file("four.csv",
             "id_tree,species,x,y,dbh_cm\n1,Fagus sylvatica,2,2,20\n2,Picea abies,8,2,25\n"
             "3,Fagus sylvatica,2,8,22\n4,Fagus sylvatica,8,8,24\n");
  write_file("plot.csv", "x,y\n0,0\n10,0\n10,10\n0,10\n");
  write_file("radiation.csv", "month,global_horizontal_mj_m2,diffuse_fraction\n6,560,0.5\n7,570,0.5\n");
  write_file("sensors.csv", "id_sensor,x,y,h_m,pacl\nmiddle,5,5,1,0.2\nedge,1,5,1,0.1\n");
}

std::string out(const std::string& name) { return (test::scratch_dir() / name).string(); }

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string files_at(const std::string& folder) {
  fs::create_directory(test::scratch_dir() / folder);
  return " --netcdf " + out(folder + "/s.nc") + " --csv " + out(folder + "/tables") + " --report " +
         out(folder + "/r.html") + " --pictures " + out(folder + "/pictures") + " --photographs " +
         out(folder + "/photographs") + " --photograph-px 32 --geotiff " + out(folder + "/ground.tif") +
         " --epsg 32632";
}

std::set<std::string> files_under(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) names.insert(fs::relative(entry.path(), folder).string());
  return names;
}

// Times are never the same twice.
std::string without_times(std::string text) {
  return std::regex_replace(text, std::regex("[0-9.]+(&nbsp;| )s\\b"), "T");
}

void expect_same_numbers(const fs::path& served, const fs::path& local) {
  const StandTables a = load_stand_netcdf(served), b = load_stand_netcdf(local);
  EXPECT_EQ(a.intervals, b.intervals);
  EXPECT_EQ(a.virtual_trees, b.virtual_trees);
  EXPECT_EQ(a.provenance.notes, b.provenance.notes);
  EXPECT_EQ(a.provenance.settings, b.provenance.settings);
  ASSERT_EQ(a.tables.size(), b.tables.size());
  for (std::size_t t = 0; t < b.tables.size(); ++t) {
    ASSERT_EQ(a.tables[t].variables.size(), b.tables[t].variables.size());
    for (std::size_t v = 0; v < b.tables[t].variables.size(); ++v) {
      EXPECT_EQ(a.tables[t].variables[v].name, b.tables[t].variables[v].name);
      const auto &x = a.tables[t].variables[v].value, &y = b.tables[t].variables[v].value;
      EXPECT_TRUE(std::equal(x.begin(), x.end(), y.begin(), y.end(), [](double p, double q) {
        return p == q || (std::isnan(p) && std::isnan(q));
      })) << a.tables[t].variables[v].name;
    }
  }
}

class ClientStand : public ::testing::TestWithParam<const char*> {};

TEST_P(ClientStand, WritesTheSameFilesAsTheCommandAtHome) {
  write_tables();
  const std::string kind = GetParam();
  const std::string scene = write_file(kind + ".toml", scene_with(kind)).string();
  const Ran local = run("stand " + scene + files_at(kind + "_local"));
  ASSERT_EQ(local.code, 0) << local.text;

  const test::ServedProcess server;
  const std::string client = " --address " + server.target() + " --scene-file " + scene;
  const Ran created = run("client create" + client);
  ASSERT_EQ(created.code, 0) << created.text;
  const std::size_t at = created.text.find("scenes/");
  ASSERT_NE(at, std::string::npos) << created.text;
  const std::string name = created.text.substr(at, created.text.find(' ', at) - at);
  const Ran served = run("client stand" + client + " --scene " + name + files_at(kind + "_served") +
                         " --json " + out(kind + ".json"));
  ASSERT_EQ(served.code, 0) << served.text;

  const fs::path from = test::scratch_dir() / (kind + "_served"),
                 home = test::scratch_dir() / (kind + "_local");
  const std::set<std::string> names = files_under(home);
  EXPECT_EQ(files_under(from), names);
  EXPECT_GE(names.size(), 17u);
  for (const std::string& file : names) {
    if (file == "s.nc") continue;
    if (file == "r.html")
      EXPECT_TRUE(without_times(content(from / file)) == without_times(content(home / file)));
    else
      EXPECT_TRUE(content(from / file) == content(home / file)) << file;
  }
  expect_same_numbers(from / "s.nc", home / "s.nc");
  EXPECT_NE(content(test::scratch_dir() / (kind + ".json")).find("\"plot\""), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(All, ClientStand, ::testing::Values("periodic", "natural"),
                         [](const auto& test) { return std::string(test.param); });

// A selection of trees, served and at home: the same tables, of those trees alone.
TEST(ClientLight, TakesASelectionOfTrees) {
  write_tables();
  const std::string light = R"(
[light]
method = "grid"
[light.sun]
zenith_deg = 30
azimuth_deg = 160
[[light.bands]]
name = "PAR"
beam_normal_w_m2 = 400
diffuse_horizontal_w_m2 = 80
)";
  std::string text = scene_with("periodic");
  text = text.substr(0, text.find("[stand_light]")) + light;
  const std::string scene = write_file("some.toml", text).string();
  ASSERT_EQ(run("grow " + scene + " -o " + out("some.vdb")).code, 0);
  const Ran local = run("light " + out("some.vdb") + " --scene " + scene + " --trees 4,2 --csv " +
                        out("local.csv") + " --tree-csv " + out("local_trees.csv"));
  ASSERT_EQ(local.code, 0) << local.text;
  const test::ServedProcess server;
  const std::string client = " --address " + server.target() + " --scene-file " + scene;
  const Ran created = run("client create" + client);
  const std::size_t at = created.text.find("scenes/");
  ASSERT_NE(at, std::string::npos) << created.text;
  const std::string name = created.text.substr(at, created.text.find(' ', at) - at);
  const std::string ask = "client light" + client + " --scene " + name + " --csv " + out("served.csv") +
                          " --tree-csv " + out("served_trees.csv") + " --trees ";
  const Ran served = run(ask + "4,2");
  ASSERT_EQ(served.code, 0) << served.text;
  EXPECT_TRUE(content(out("served.csv")) == content(out("local.csv")));
  EXPECT_EQ(content(out("served_trees.csv")), content(out("local_trees.csv")));
  const std::string trees = content(out("local_trees.csv"));
  EXPECT_EQ(std::count(trees.begin(), trees.end(), '\n'), 3);  // a header and two trees
  const Ran refused = run(ask + "77");
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.text.find("light.id_trees[0]"), std::string::npos) << refused.text;
}

TEST(ClientStandMistakes, AreToldBeforeTheServerIsAsked) {
  write_tables();
  const std::string scene = write_file("m.toml", scene_with("periodic")).string();
  const test::ServedProcess server;
  const std::string client = "client stand --address " + server.target() + " --scene-file " + scene;
  const std::string name = " --scene scenes/" + std::string(64, '0');
  struct Bad {
    std::string arguments, says;
  };
  for (const Bad& bad :
       {Bad{client + name, "--report FILE.html"}, Bad{client + name + " --report a.txt", ".html"},
        Bad{client + name + " --csv /nonexistent/a/b", "there is no folder"},
        Bad{client + " --json " + out("a.json"), "--scene"},
        Bad{client + name + " --json " + out("a.json"), "was not made from"}}) {
    const Ran ran = run(bad.arguments);
    EXPECT_EQ(ran.code, 2) << bad.arguments << "\n" << ran.text;
    EXPECT_NE(ran.text.find(bad.says), std::string::npos) << bad.arguments << "\n" << ran.text;
  }
}

}  // namespace
}  // namespace sunfleck
