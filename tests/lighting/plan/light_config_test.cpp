// The [light] table: what it means and what it refuses, with file, line and key.
#include "lighting/plan/light_config.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

LightRequest read(const std::string& text) {
  const ConfigTable root = ConfigTable::from_text(text, "scene.toml");
  LightRequest request = read_light_request(root.table("light"));
  root.reject_unread();
  return request;
}

const std::string kGood = R"(
[light]
method = "spp_g"
[light.sun]
zenith_deg = 60
azimuth_deg = 90
[light.sky]
model = "standard_overcast"
[[light.bands]]
name = "PAR"
soil_albedo = 0.2
direct_horizontal_w_m2 = 100
diffuse_horizontal_w_m2 = 50
)";

TEST(LightConfig, ReadsSunSkyAndBands) {
  const LightRequest r = read(kGood);
  EXPECT_EQ(r.method, Method::kSppG);
  EXPECT_NEAR(r.light.to_sun.x, std::sin(radians_from_degrees(60)), 1e-15);
  EXPECT_EQ(r.light.sky, SkyModel::kStandardOvercast);
  EXPECT_NEAR(r.light.bands[0].beam_normal_w_m2, 200, 1e-9);  // 100 / cos 60
  EXPECT_NEAR(r.light.sun_half_angle_rad, radians_from_degrees(0.265), 1e-15);
  EXPECT_EQ(r.optics.bands, std::vector<std::string>{"PAR"});
}

TEST(LightConfig, FindsTheSunByPlaceAndTime) {
  const LightRequest r = read(R"(
[light]
[light.sun]
latitude_deg = 39.742476
longitude_deg = -105.1786
elevation_m = 1830.14
pressure_hpa = 820
temperature_c = 11
time = "2003-10-17T19:30:30Z"
[[light.bands]]
name = "PAR"
beam_normal_w_m2 = 1
)");
  EXPECT_NEAR(degrees_from_radians(zenith_of(r.light.to_sun)), 50.11162, 1e-3);
}

TEST(LightConfig, RefusesMistakesByLineAndKey) {
  struct Bad {
    std::string from, to, where, says;
  };
  const std::vector<Bad> table = {
      {"\"spp_g\"", "\"magic\"", "scene.toml:3", "magic"},
      {"zenith_deg = 60", "zenith_deg = 260", "scene.toml:5", "180"},
      {"zenith_deg = 60", "zenith_deg = nan", "scene.toml:5", "nan"},
      {"standard_overcast", "purple", "scene.toml:8", "uniform"},
      {"soil_albedo = 0.2", "soil_albedo = 1.2", "scene.toml:11", "1"},
      {"soil_albedo", "soil_albedoo", "scene.toml:11", "soil_albedo"},
      {"diffuse_horizontal_w_m2 = 50", "diffuse_horizontal_w_m2 = -50", "scene.toml:13", "-50"},
      {"zenith_deg = 60", "zenith_deg = 95", "scene.toml:12", "horizon"},
      {"diffuse_horizontal_w_m2 = 50", "beam_normal_w_m2 = 50", "scene.toml:13", "one of the two"},
      {"[[light.bands]]\nname = \"PAR\"", "[[light.bands]]", "scene.toml", "name"},
  };
  for (const Bad& bad : table) {
    std::string text = kGood;
    text.replace(text.find(bad.from), bad.from.size(), bad.to);
    try {
      read(text);
      FAIL() << bad.to;
    } catch (const Error& error) {
      EXPECT_EQ(error.where().rfind(bad.where, 0), 0u) << error.what();
      EXPECT_NE(std::string(error.what()).find(bad.says), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace sunfleck
