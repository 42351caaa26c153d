// `sunfleck client render` against `sunfleck render`: one scene file, the same picture.
#include <gtest/gtest.h>

#include <sstream>

#include "tests/server/apps/run_program.h"
#include "tests/server/served.h"

namespace sunfleck::test {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::string in_quotes(const fs::path& path) { return "'" + path.string() + "'"; }

constexpr char kScene[] = R"([forest]
name = "two"
trees = "crown"
elements_per_tree = 300
plot_width_m = 12
plot_depth_m = 6
form = "open"
[[forest.planting]]
species = "beech"
count = 2
pattern = "rows"
spacing_m = 6
[light]
method = "spp_g"
[light.sun]
zenith_deg = 40
azimuth_deg = 200
[light.sky]
model = "uniform"
[[light.bands]]
name = "PAR"
direct_horizontal_w_m2 = 300
diffuse_horizontal_w_m2 = 80
[camera]
position_m = [6, -30, 8]
look_at_m = [6, 3, 8]
width_px = 80
height_px = 60
[render]
mode = "path_traced"
noise = 0.4
max_samples_per_pixel = 32
ground = "grass"
leaf_gloss = 0.2
tone = "filmic"
exposure_stops = 0.5
)";

class ClientRender : public ::testing::Test {
 protected:
  void SetUp() override {
    const Ran created =
        run("client create --address " + server_.target() + " --scene-file " + in_quotes(scene_));
    ASSERT_EQ(created.code, 0) << created.text;
    name_ = created.text.substr(created.text.find("scenes/"), 7 + 64);
  }
  Ran client(const std::string& options) {
    return run("client render --address " + server_.target() + " --scene " + name_ + " --scene-file " +
               in_quotes(scene_) + " " + options);
  }
  ServedProcess server_;
  fs::path scene_ = write_file("two.toml", kScene);
  std::string name_;
};

TEST_F(ClientRender, TheSameFilesAsWithoutAServer) {
  const fs::path vdb = scratch_dir() / "two.vdb", here = scratch_dir() / "here",
                 there = scratch_dir() / "there";
  ASSERT_EQ(run("grow " + in_quotes(scene_) + " -o " + in_quotes(vdb)).code, 0);
  const Ran local = run("render " + in_quotes(vdb) + " --scene " + in_quotes(scene_) + " --png " +
                        in_quotes(here.string() + ".png") + " --exr " + in_quotes(here.string() + ".exr"));
  ASSERT_EQ(local.code, 0) << local.text;
  const Ran served =
      client("--png " + in_quotes(there.string() + ".png") + " --exr " + in_quotes(there.string() + ".exr"));
  ASSERT_EQ(served.code, 0) << served.text;
  EXPECT_NE(served.text.find("noise"), std::string::npos) << served.text;
  for (const char* kind : {".png", ".exr"})
    EXPECT_TRUE(bytes_of(here.string() + kind) == bytes_of(there.string() + kind)) << kind;
}

TEST_F(ClientRender, ModeAndTimeAreOptions) {
  const fs::path png = scratch_dir() / "picture.png";
  const Ran mapped = client("--mode light_map --png " + in_quotes(png));
  EXPECT_EQ(mapped.code, 0) << mapped.text;
  const std::string from_map = bytes_of(png);
  const Ran timed = client("--stop-after 100 --png " + in_quotes(png));
  EXPECT_EQ(timed.code, 0) << timed.text;
  EXPECT_EQ(timed.text.find("stopped early"), std::string::npos) << timed.text;
  EXPECT_NE(bytes_of(png), from_map);
  const Ran hasty = client("--stop-after 0.000001 --png " + in_quotes(png));
  EXPECT_EQ(hasty.code, 2) << hasty.text;
  EXPECT_NE(hasty.text.find("before every pixel"), std::string::npos) << hasty.text;
  EXPECT_NE(client("--mode fast --png " + in_quotes(png)).code, 0);
}

}  // namespace
}  // namespace sunfleck::test
