// `sunfleck stand` and `sunfleck inventory check` on the real command line: what they write and print, exit
// codes, one clear error for every mistake, and every shipped stand and table.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "lighting/map/stand_netcdf.h"
#include "tests/server/apps/run_program.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

namespace fs = std::filesystem;

using test::Ran;
using test::run;
using test::write_file;

const char kScene[] = R"(
[forest]
name = "four trees"
trees = "crown"
inventory = "four.csv"
plot_polygon = "plot.csv"
elements_per_tree = 50
[forest.surroundings]
kind = "periodic"
[stand_light]
latitude_deg = 50
longitude_deg = 5
from = "2021-06-01T00:00+01:00"
to = "2021-08-01T00:00+01:00"
radiation = "radiation.csv"
sensors = "sensors.csv"
ground_cell_m = 5
rays_per_cell = 100
sensor_sun_rays = 1
sensor_sky_rays = 2
patch_deg = 15
bin_deg = 10
)";

// The scene on disk with its tables.
std::string scene() {
  static const std::string path = [] {
    write_file("four.csv",
               "id_tree,species,x,y,dbh_cm\n1,Fagus sylvatica,2,2,20\n2,Picea abies,8,2,25\n"
               "3,Fagus sylvatica,2,8,22\n4,Fagus sylvatica,8,8,24\n");
    write_file("plot.csv", "x,y\n0,0\n10,0\n10,10\n0,10\n");
    write_file("radiation.csv",
               "month,global_horizontal_mj_m2,diffuse_fraction\n6,560,0.5\n7,570,0.5\n12,0,0.5\n");
    write_file("sensors.csv", "id_sensor,x,y,h_m,pacl\nmiddle,5,5,1,0.2\nedge,1,5,1,0.1\n");
    return write_file("scene.toml", kScene).string();
  }();
  return path;
}

std::string spoiled(const std::string& name, const std::string& from, const std::string& to) {
  scene();
  std::string text = kScene;
  text.replace(text.find(from), from.size(), to);
  return write_file(name, text).string();
}

std::string out(const std::string& name) { return (test::scratch_dir() / name).string(); }

TEST(StandCommand, WritesEverythingAskedForAndSaysWhatAPersonWantsToKnow) {
  const Ran ran = run("stand " + scene() + " --netcdf " + out("s.nc") + " --csv " + out("tables") +
                      " --report " + out("r.html") + " --pictures " + out("pictures") + " --photographs " +
                      out("photographs") + " --photograph-px 32 --geotiff " + out("ground.tif"));
  ASSERT_EQ(ran.code, 0) << ran.text;
  for (const char* file :
       {"s.nc", "r.html", "tables/trees.csv", "tables/sensors.csv", "tables/ground.csv", "tables/layers.csv",
        "tables/plot.csv", "pictures/ground_map.png", "pictures/height_profile.png", "pictures/season.png",
        "pictures/sensors.png", "photographs/sensor_middle.png", "photographs/sensor_edge.png",
        "photographs/sensor_edge_sun_paths.png", "ground.tif"})
    EXPECT_GT(fs::file_size(test::scratch_dir() / file), 200u) << file;
  for (const char* text :
       {"4 trees", "1130 MJ m-2 global (50 % of it diffuse)", "leaf area index", "leaves absorb", "2021-06",
        "middle", "measured     2 sensors: RMSE", "bias", "correlation", "time"})
    EXPECT_NE(ran.text.find(text), std::string::npos) << text << "\n" << ran.text;
  const StandTables read = load_stand_netcdf(out("s.nc"));
  EXPECT_EQ(read.trees.size(), 4u);
  EXPECT_EQ(read.intervals.size(), 3u);
  EXPECT_NEAR(read.map.size_m().x, 10, 1e-9);
  const Ran info = run("info " + out("s.nc"));
  EXPECT_EQ(info.code, 0);
  EXPECT_NE(info.text.find("measured     2 sensors: RMSE"), std::string::npos) << info.text;
}

TEST(StandCommand, TakesAForestFromAFile) {
  ASSERT_EQ(run("grow " + scene() + " -o " + out("f.vdb")).code, 0);
  const std::string no_forest =
      write_file("no_forest.toml", std::string(kScene).substr(std::string(kScene).find("[stand_light]")))
          .string();
  EXPECT_EQ(run("stand " + no_forest + " --forest " + out("f.vdb") + " --netcdf " + out("f.nc")).code, 0);
  const Ran refused = run("stand " + no_forest + " --netcdf " + out("never.nc"));
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.text.find("--forest"), std::string::npos) << refused.text;
}

TEST(StandCommand, PolarNightIsZeroNotAnError) {
  std::string text = kScene;
  text.replace(text.find("latitude_deg = 50"), 17, "latitude_deg = 85");
  text.replace(text.find("2021-06-01T00:00+01:00"), 22, "2021-12-05T00:00+01:00");
  text.replace(text.find("2021-08-01T00:00+01:00"), 22, "2021-12-20T00:00+01:00");
  scene();
  const Ran ran = run("stand " + write_file("night.toml", text).string() + " --csv " + out("night"));
  ASSERT_EQ(ran.code, 0) << ran.text;
  EXPECT_NE(ran.text.find("the sun does not rise"), std::string::npos) << ran.text;
  EXPECT_NE(ran.text.find("0 MJ m-2 global"), std::string::npos) << ran.text;
  EXPECT_EQ(ran.text.find("nan"), std::string::npos) << ran.text;
}

TEST(StandCommand, OneClearErrorForEveryMistakeAndNothingLeftBehind) {
  const std::string nc = out("never.nc");
  write_file("outside.csv", "id_sensor,x,y\na,50,5\n");
  write_file("inside.csv", "id_sensor,x,y\na,2,2\n");
  write_file("percent.csv", "id_sensor,x,y,pacl\na,5,5,22\n");
  write_file("winter.csv", "month,global_horizontal_mj_m2,diffuse_fraction\n1,80,0.5\n");
  write_file("crossed.csv", "x,y\n0,0\n10,10\n10,0\n0,10\n");
  struct Bad {
    std::string arguments, says;
  };
  const std::vector<Bad> table = {
      {"stand nowhere.toml --netcdf " + nc, "nowhere.toml"},
      {"stand " + scene(), "--report FILE.html"},
      {"stand " + scene() + " --netcdf a.txt", ".nc"},
      {"stand " + scene() + " --report /nonexistent/r.html", "there is no folder"},
      {"stand " + scene() + " --geotiff a.png", ".tif"},
      {"stand " + scene() + " --netcdf " + nc + " --epsg 32632", "--geotiff"},
      {"stand " + scene() + " --csv " + scene(), "is a file"},
      {"stand " + scene() + " --csv /nonexistent/a/b", "there is no folder"},
      {"stand " + scene() + " --forest nowhere.vdb --netcdf " + nc, "nowhere.vdb"},
      {"stand configs/scenes/glade.toml --netcdf " + nc, "[stand_light]"},
      {"stand " + spoiled("b1.toml", "rays_per_cell", "rays_per_cel") + " --netcdf " + nc, "rays_per_cel"},
      {"stand " + spoiled("b2.toml", "06-01T00:00+01:00", "06-01T00:00") + " --netcdf " + nc, "zone"},
      {"stand " + spoiled("b3.toml", "radiation.csv", "winter.csv") + " --netcdf " + nc, "2021-06"},
      {"stand " + spoiled("b4.toml", "sensors.csv", "outside.csv") + " --netcdf " + nc, "sensors[0] (a)"},
      {"stand " + spoiled("b5.toml", "sensors.csv", "inside.csv") + " --netcdf " + nc, "tree 1"},
      {"stand " + spoiled("b6.toml", "sensors.csv", "percent.csv") + " --netcdf " + nc, "percent"},
      {"stand " + spoiled("b7.toml", "plot.csv", "crossed.csv") + " --netcdf " + nc, "cross"},
      {"stand " + spoiled("b8.toml", "latitude_deg = 50", "latitude_deg = 95") + " --netcdf " + nc,
       "latitude_deg"},
      {"stand " + spoiled("b9.toml", "2021-08-01", "2021-05-01") + " --netcdf " + nc, "stand_light.to"},
      {"stand " + spoiled("b10.toml", "sensors = \"sensors.csv\"\n", "") + " --photographs " + out("no"),
       "sensors"},
  };
  for (const Bad& bad : table) {
    const Ran ran = run(bad.arguments);
    EXPECT_EQ(ran.code, 2) << bad.arguments << "\n" << ran.text;
    EXPECT_NE(ran.text.find(bad.says), std::string::npos) << bad.arguments << "\n" << ran.text;
    EXPECT_EQ(ran.text.find("internal error"), std::string::npos) << ran.text;
  }
  EXPECT_FALSE(fs::exists(nc));
}

TEST(InventoryCommand, ListsEveryProblemWithRowColumnAndRemedy) {
  const std::string good =
      write_file("good.csv", "id_tree,species,x,y,dbh_cm\n1,Fagus sylvatica,2,2,20\n").string();
  const Ran fine = run("inventory check " + good);
  EXPECT_EQ(fine.code, 0) << fine.text;
  EXPECT_NE(fine.text.find("1 tree, 1 of them good; 0 errors, 0 warnings"), std::string::npos) << fine.text;

  const std::string bad =
      write_file("bad.csv",
                 "id_tree,species,x,y,dbh_cm,h_m,hbase_m\n1,Fagus sylvatica,0,0,20,15,20\n"
                 "1,Picea abies,3,0,-4,20,5\n3,Unknownia,6,x,30,20,5\n")
          .string();
  const Ran listed = run("inventory check " + bad);
  EXPECT_EQ(listed.code, 2) << listed.text;
  for (const char* text : {"bad.csv:2", "bad.csv:3", "bad.csv:4, column y", "column dbh_cm", "-> "})
    EXPECT_NE(listed.text.find(text), std::string::npos) << text << "\n" << listed.text;

  const std::string bare =
      write_file("bare.csv", "id_tree,species,x,y,dbh\n1,Fagus sylvatica,2,2,20\n").string();
  const Ran warned = run("inventory check " + bare);
  EXPECT_EQ(warned.code, 0) << warned.text;  // the unit of dbh was inferred
  EXPECT_NE(warned.text.find("warning"), std::string::npos) << warned.text;
}

TEST(InventoryCommand, LooksAtThePlotToo) {
  const std::string trees = write_file("two.csv",
                                       "id_tree,species,x,y,dbh_cm\n1,Fagus sylvatica,2,2,20\n"
                                       "2,Fagus sylvatica,40,2,20\n")
                                .string();
  const Ran outside =
      run("inventory check " + trees + " --plot " + write_file("p.csv", "x,y\n0,0\n9,0\n9,9\n").string());
  EXPECT_EQ(outside.code, 0);
  EXPECT_NE(outside.text.find("two.csv:3: the tree stands outside the plot"), std::string::npos)
      << outside.text;
  const Ran crossed = run("inventory check " + trees + " --plot " +
                          write_file("x.csv", "x,y\n0,0\n9,9\n9,0\n0,9\n").string());
  EXPECT_EQ(crossed.code, 2);
  EXPECT_NE(crossed.text.find("cross"), std::string::npos) << crossed.text;
  const Ran absent = run("inventory check nowhere.csv");
  EXPECT_EQ(absent.code, 2);
  EXPECT_NE(absent.text.find("nowhere.csv"), std::string::npos);
}

// A shipped stand with few rays and few leaves, in a copy of its folder; empty if it asks for no stand light.
std::string cheap_copy(const fs::path& scene_file, const fs::path& folder) {
  std::ifstream in(scene_file);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::size_t table = text.find("[stand_light]\n");
  if (table == std::string::npos) return {};
  text.insert(table + 14,
              "rays_per_cell = 5\nsensor_sun_rays = 1\nsensor_sky_rays = 1\npatch_deg = 30\nbin_deg = 30\n");
  if (const std::size_t at = text.find("elements_per_tree = 1000"); at != std::string::npos)
    text.replace(at, 24, "elements_per_tree = 20");
  else
    text.insert(text.find("realism = "), "element_area_m2 = 3\n");
  const std::string data = "../../../shared/data/stands/cloture20";
  if (text.find(data) != std::string::npos) {
    const auto measured = test::shared_data("stands/cloture20/trees.csv");
    if (!measured) return {};
    for (std::size_t at; (at = text.find(data)) != std::string::npos;)
      text.replace(at, data.size(), fs::absolute(measured->parent_path()).string());
  }
  std::ofstream(folder / scene_file.filename()) << text;
  return (folder / scene_file.filename()).string();
}

TEST(ShippedConfigs, EveryStandIsAnswered) {
  std::size_t stands = 0;
  for (const char* name : {"scenes", "examples"}) {
    const fs::path folder = test::scratch_dir() / name;
    fs::copy(test::source_dir() / "configs" / name, folder);
    for (const auto& entry : fs::directory_iterator(test::source_dir() / "configs" / name)) {
      if (entry.path().extension() != ".toml") continue;
      const std::string copy = cheap_copy(entry.path(), folder);
      if (copy.empty()) continue;
      ++stands;
      const Ran ran = run("stand " + copy + " --csv " + out(entry.path().stem().string()));
      EXPECT_EQ(ran.code, 0) << entry.path() << "\n" << ran.text;
    }
  }
  EXPECT_GE(stands, 1u);
}

TEST(ShippedConfigs, ExampleInventoryHasNoProblem) {
  const Ran ran = run("inventory check configs/examples/trees.csv --plot configs/examples/plot.csv");
  EXPECT_EQ(ran.code, 0) << ran.text;
  EXPECT_NE(ran.text.find("40 trees, 40 of them good; 0 errors, 0 warnings"), std::string::npos) << ran.text;
}

}  // namespace
}  // namespace sunfleck
