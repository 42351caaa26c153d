// The real program on the real command line: help, exit codes, one clear error for every mistake, nothing
// left behind.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <string>

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
name = "three trees"
trees = "crown"
inventory = "three.csv"
elements_per_tree = 200
[light]
method = "reference"
[light.sun]
zenith_deg = 40
azimuth_deg = 180
[light.sky]
model = "uniform"
[[light.bands]]
name = "PAR"
soil_albedo = 0.1
direct_horizontal_w_m2 = 300
diffuse_horizontal_w_m2 = 100
[light.reference]
rays_per_face = 8
[camera]
position_m = [0, -30, 10]
look_at_m = [0, 0, 8]
width_px = 64
height_px = 48
samples_per_pixel = 1
)";

// A scene on disk with its inventory, and the forest grown from it.
struct Stand {
  fs::path scene, forest, map;
};
const Stand& stand() {
  static const Stand made = [] {
    write_file("three.csv",
               "id_tree,species,x,y,dbh_cm\n1,Fagus sylvatica,0,0,30\n2,Picea abies,6,0,25\n3,Pinus "
               "sylvestris,0,6,28\n");
    Stand s{write_file("scene.toml", kScene), test::scratch_dir() / "stand.vdb",
            test::scratch_dir() / "light.nc"};
    const Ran grown = run("grow '" + s.scene.string() + "' -o '" + s.forest.string() + "'");
    EXPECT_EQ(grown.code, 0) << grown.text;
    const Ran lit = run("light '" + s.forest.string() + "' --scene '" + s.scene.string() + "' -o '" +
                        s.map.string() + "'");
    EXPECT_EQ(lit.code, 0) << lit.text;
    return s;
  }();
  return made;
}

TEST(CommandLine, HelpsWithExamplesOnEveryCommand) {
  for (const char* c : {"grow", "light", "render", "stand", "inventory", "inventory check", "serve", "client",
                        "info", "import", "export", "bench"}) {
    const Ran ran = run(std::string(c) + " --help");
    EXPECT_EQ(ran.code, 0) << c;
    EXPECT_NE(ran.text.find("Examples:"), std::string::npos) << c;
  }
  EXPECT_EQ(run("--help").code, 0);
  EXPECT_NE(run("--version").text.find("sunfleck "), std::string::npos);
}

TEST(CommandLine, GrowsLightsRendersAndDescribes) {
  const std::string forest = "'" + stand().forest.string() + "'", scene = "'" + stand().scene.string() + "'";
  const std::string png = (test::scratch_dir() / "a.png").string(),
                    exr = (test::scratch_dir() / "a.exr").string();
  const Ran rendered = run("render " + forest + " --light-map '" + stand().map.string() + "' --scene " +
                           scene + " --png " + png + " --exr " + exr);
  EXPECT_EQ(rendered.code, 0) << rendered.text;
  EXPECT_TRUE(fs::exists(png) && fs::exists(exr));
  EXPECT_NE(run("info " + forest).text.find("3 prototypes"), std::string::npos);
  EXPECT_NE(run("info '" + stand().map.string() + "'").text.find("reference"), std::string::npos);
}

TEST(CommandLine, WritesTheSameTableForAnyNumberOfThreads) {
  const std::string common =
      "light '" + stand().forest.string() + "' --scene '" + stand().scene.string() + "' --csv ";
  const fs::path one = test::scratch_dir() / "one.csv", two = test::scratch_dir() / "two.csv";
  ASSERT_EQ(run(common + one.string() + " --threads 1").code, 0);
  ASSERT_EQ(run(common + two.string() + " --threads 2").code, 0);
  std::ifstream a(one), b(two);
  const std::string first((std::istreambuf_iterator<char>(a)), {}),
      second((std::istreambuf_iterator<char>(b)), {});
  EXPECT_GT(first.size(), 10000u);
  EXPECT_EQ(first, second);
}

TEST(CommandLine, ImportsAndExportsAPrototype) {
  const fs::path leaves = write_file("few.txt", "0.1 0 0 2 0 0 1\n0.1 0.5 0 2 0.6 0 0.8\n");
  const fs::path vdb = test::scratch_dir() / "few.vdb", obj = test::scratch_dir() / "few.obj";
  const Ran in = run("import " + leaves.string() + " --material 'Fagus sylvatica' -o " + vdb.string());
  EXPECT_EQ(in.code, 0) << in.text;
  EXPECT_NE(in.text.find("2 foliage elements"), std::string::npos) << in.text;
  EXPECT_EQ(run("export " + vdb.string() + " -o " + obj.string()).code, 0);
  EXPECT_GT(fs::file_size(obj), 100u);
}

TEST(CommandLine, AScannedTreeGetsLeavesAndGoesOutAgain) {
  const fs::path cylinders = write_file(
      "scan.csv", "id,parent,x,y,z,end_x,end_y,end_z,radius\n1,0,0,0,0,0,0,2,0.1\n2,1,0,0,2,1,0,2,0.005\n");
  const fs::path vdb = test::scratch_dir() / "scan.vdb", glb = test::scratch_dir() / "scan.glb",
                 csv = test::scratch_dir() / "again.csv";
  const Ran in = run("import " + cylinders.string() +
                     " --material 'Fagus sylvatica' --leaf-area 3 --elements 50 -o " + vdb.string());
  EXPECT_EQ(in.code, 0) << in.text;
  EXPECT_NE(in.text.find("50 foliage elements"), std::string::npos) << in.text;
  const Ran out = run("export " + vdb.string() + " -o " + glb.string());
  EXPECT_EQ(out.code, 0) << out.text;
  EXPECT_NE(out.text.find("1 meshes, 1 trees"), std::string::npos) << out.text;
  EXPECT_EQ(run("export " + vdb.string() + " --format qsm -o " + csv.string()).code, 0);
  EXPECT_GT(fs::file_size(csv), 100u);
}

TEST(CommandLine, TellsOneClearErrorAndLeavesNothingBehind) {
  const std::string out = (test::scratch_dir() / "never.vdb").string(),
                    nc = (test::scratch_dir() / "never.nc").string(),
                    png = (test::scratch_dir() / "never.png").string();
  const std::string forest = stand().forest.string(), scene = stand().scene.string();
  const auto spoiled = [&](const std::string& name, const std::string& from, const std::string& to) {
    std::string text = kScene;
    text.replace(text.find(from), from.size(), to);
    return write_file(name, text).string();
  };
  write_file("nan.csv", "id_tree,species,x,y,dbh_cm\n1,Fagus sylvatica,0,nan,30\n");
  write_file("none.csv", "id_tree,species,x,y,dbh_cm\n");
  const std::string truncated = (test::scratch_dir() / "truncated.vdb").string();
  fs::copy_file(forest, truncated);
  fs::resize_file(truncated, fs::file_size(truncated) / 2);
  const std::string grammar = write_file("bad.lsys", "axiom: A(\n").string();
  const std::string leaves = write_file("leaf.txt", "0.1 0 0 2 0 0 1\n").string();
  const std::string other = (test::scratch_dir() / "other.vdb").string();
  EXPECT_EQ(run("import " + leaves + " --material 'Fagus sylvatica' -o " + other).code, 0);
  const auto places = [&](const std::string& name, const std::string& line) {
    return "import " + leaves + " --instances " + write_file(name, line).string() + " -o " + out;
  };
  struct Bad {
    std::string arguments, says;
  };
  const std::vector<Bad> table = {
      {"", "subcommand"},
      {"fly", "fly"},
      {"grow nowhere.toml -o " + out, "nowhere.toml"},
      {"grow " + scene, "-o FILE.vdb"},
      {"grow " + scene + " -o out.obj", ".vdb"},
      {"grow --lsystem " + grammar + " -o " + out, "bad.lsys:1"},
      {"grow " + spoiled("s2.toml", "elements_per_tree", "elements_per_treee") + " -o " + out, "s2.toml:6"},
      {"grow " + spoiled("s3.toml", "three.csv", "nan.csv") + " -o " + out, "nan.csv:2"},
      {"grow " + spoiled("s4.toml", "three.csv", "none.csv") + " -o " + out, "none.csv"},
      {"grow " + spoiled("s5.toml", "= 200", "= -200") + " -o " + out, "s5.toml:6"},
      {"light " + truncated + " --scene " + scene + " -o " + nc, "truncated.vdb"},
      {"light nowhere.vdb --scene " + scene + " -o " + nc, "nowhere.vdb"},
      {"light " + scene + " --scene " + scene + " -o " + nc, "scene.toml"},
      {"light " + forest + " --scene " + scene, "-o FILE.nc"},
      {"light " + forest + " --scene " + scene + " --method magic -o " + nc, "spp_g"},
      {"light " + forest + " --scene " + spoiled("s6.toml", "zenith_deg = 40", "zenith_deg = 400") + " -o " +
           nc,
       "s6.toml:10"},
      {"light " + forest + " --scene " + spoiled("s7.toml", "\"PAR\"", "\"UV\"") + " -o " + nc, "bands.UV"},
      {"render " + forest + " --light-map nowhere.nc --scene " + scene + " --png " + png, "nowhere.nc"},
      {"render " + forest + " --light-map " + scene + " --scene " + scene + " --png " + png, "scene.toml"},
      {"render " + forest + " --light-map " + stand().map.string() + " --scene " +
           spoiled("s8.toml", "width_px = 64", "width_px = 0") + " --png " + png,
       "s8.toml"},
      {"info nowhere.vdb", "nowhere.vdb"},
      {"import nowhere.txt -o " + out, "nowhere.txt"},
      {"import " + write_file("bad.txt", "0.1 0 0 x 0 0 1\n").string() + " -o " + out, "bad.txt:1"},
      {"export " + forest + " --prototype 99 -o " + out, "0 to 2"},
      {"bench error-vs-time --scenes moon", "sphere"},
      {"bench tables --quick --csv tables.txt", ".csv"},
      {"bench images --scenes moon", "bush"},
      {"bench images --ways magic", "light_map"},
      {"bench images --samples 4,1", "--samples"},
      {"bench images --repeats 1", "--repeats"},
      {"bench images --reference-samples 1", "--reference-samples"},
      {"bench images --plot pictures.txt", ".svg"},
      {"bench images --scene nowhere.toml", "nowhere.toml"},
      {"grow " + scene + " --print", "--lsystem"},
      {"grow " + scene + " -o /nonexistent/a.vdb", "there is no folder"},
      {"light " + forest + " --scene " + scene + " -o /nonexistent/a.nc", "there is no folder"},
      {"light " + forest + " --scene " + scene + " -o " + nc + " --csv a.txt", ".csv"},
      {"light " + forest + " --scene " + scene + " --csv a.csv --tree-csv a.csv", "twice"},
      {"light " + forest + " --scene " + scene + " --threads -1 -o " + nc, "--threads"},
      {"light " + forest + " --scene " +
           spoiled("s9.toml", "[light.reference]",
                   "[[light.optics]]\nmaterial = \"moon\"\nband = \"PAR\"\nleaf_reflectance = "
                   "0\nleaf_transmittance = 0\n[light.reference]") +
           " -o " + nc,
       "optics.moon"},
      {"render " + forest + " --light-map " + stand().map.string() + " --scene " +
           spoiled("s10.toml", "zenith_deg = 40", "zenith_deg = 50") + " --png " + png,
       "sun_zenith_deg"},
      {"render " + other + " --light-map " + stand().map.string() + " --scene " + scene + " --png " + png,
       "another forest"},
      {"render " + forest + " --mode path_traced --scene " +
           spoiled("s11.toml", "width_px = 64", "width_px = 100000") + " --png " + png,
       "1 to 16384"},
      {"render " + forest + " --mode path_traced --scene " +
           spoiled("s12.toml", "[light.reference]",
                   "[[render.textures]]\nleaf_alpha = \"absent.png\"\n[light.reference]") +
           " --png " + png,
       "absent.png"},
      {places("nan.txt", "nan 0 0\n"), "nan.txt:1"},
      {places("size.txt", "0 0 0 nan 0\n"), "size.txt:1"},
      {places("far.txt", "0 0 0\n0 -1e300 0\n"), "far.txt:2"},
      {"import " + leaves + " --period 0 0 1e-9 1 -o " + out, "1000 periods"},
      {"import " +
           write_file("a.obj", "v 0 0 1\nv 1 0 1\nv 1 1 1\nusemtl leaf\nf 1 2 3\nusemtl moss\nf 1 2 3\n")
               .string() +
           " --leaf leaf=leaf -o " + out,
       "a.obj:7: material \"moss\""},
      {"grow --lsystem " +
           write_file("endless.lsys", "symbols: A\naxiom: A\ndecomposition:\nA --> A A\n").string() + " -o " +
           out,
       "endless.lsys:4"},
      {"client info --address unix:/nowhere.sock", "/nowhere.sock"},
  };
  for (const Bad& bad : table) {
    const Ran ran = run(bad.arguments);
    EXPECT_NE(ran.code, 0) << bad.arguments;
    if (bad.arguments.rfind("client", 0) != 0) {
      EXPECT_EQ(ran.code, 2) << bad.arguments << "\n" << ran.text;
    }
    EXPECT_NE(ran.text.find(bad.says), std::string::npos) << bad.arguments << "\n" << ran.text;
    EXPECT_EQ(ran.text.find("internal error"), std::string::npos) << ran.text;
  }
  EXPECT_FALSE(fs::exists(out));
  EXPECT_FALSE(fs::exists(nc));
  EXPECT_FALSE(fs::exists(png));
}

TEST(CommandLine, EveryShippedSceneGrows) {
  for (const auto& entry : fs::recursive_directory_iterator(test::source_dir() / "configs/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    if (entry.path().stem().string().starts_with("cloture20") &&
        !test::shared_data("stands/cloture20/trees.csv"))
      continue;
    const fs::path out = test::scratch_dir() / (entry.path().stem().string() + ".vdb");
    const Ran ran = run("grow '" + entry.path().string() + "' -o '" + out.string() + "'");
    EXPECT_EQ(ran.code, 0) << entry.path() << "\n" << ran.text;
  }
}

}  // namespace
}  // namespace sunfleck
