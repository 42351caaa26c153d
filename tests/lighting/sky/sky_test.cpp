// Sky models against their closed-form irradiance, the sun against a published ephemeris answer, bad input.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "lighting/sky/illumination.h"
#include "lighting/sky/sun_position.h"
#include "sim/base/error.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

nlohmann::json light_case(const std::string& id) {
  const nlohmann::json file = test::golden("light_cases.json");
  for (const auto& c : file["cases"])
    if (c["id"] == id) return c;
  throw std::runtime_error("no case " + id);
}

// Horizontal irradiance of a sky: 2 pi int_0^1 L(mu) mu dmu, midpoint rule.
double horizontal_irradiance(SkyModel model) {
  constexpr int n = 100000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double mu = (i + 0.5) / n;
    sum += relative_sky_radiance(model, mu) * mu;
  }
  return 2 * kPi * sum / n;
}

TEST(Sky, EveryModelPutsOneOnTheHorizontalPlane) {
  EXPECT_NEAR(horizontal_irradiance(SkyModel::kUniform), 1.0, 1e-9);
  EXPECT_NEAR(horizontal_irradiance(SkyModel::kStandardOvercast), 1.0, 1e-9);
  EXPECT_EQ(relative_sky_radiance(SkyModel::kUniform, 0.0), 0.0);
  EXPECT_EQ(relative_sky_radiance(SkyModel::kStandardOvercast, -0.5), 0.0);
}

TEST(Sky, MatchesTheGoldenRatiosToZenithRadiance) {
  const auto expected = light_case("sky_ratio")["expected"];
  const double uniform = 1.0 / relative_sky_radiance(SkyModel::kUniform, 1.0);
  const double overcast = 1.0 / relative_sky_radiance(SkyModel::kStandardOvercast, 1.0);
  EXPECT_NEAR(uniform, expected["UOC_horizontal_irradiance"].get<double>(), 1e-12);
  EXPECT_NEAR(overcast, expected["SOC_horizontal_irradiance"].get<double>(), 1e-12);
}

TEST(SunPosition, MatchesThePublishedExampleOfSpa) {
  const auto c = light_case("spa_reference");
  const Place place{39.742476, -105.1786, 1830.14, 820, 11};
  const SunPosition sun = sun_position(place, parse_utc_time("2003-10-17T12:30:30-07:00", "test"));
  EXPECT_NEAR(degrees_from_radians(sun.zenith_rad), c["expected"]["zenith"].get<double>(), 1e-3);
  EXPECT_NEAR(degrees_from_radians(sun.azimuth_rad), c["expected"]["azimuth_N_cw"].get<double>(), 1e-3);
  // Incidence on a plane of 30 degrees slope whose azimuth is turned by -10 degrees from south ([SPA] Eq.
  // 47).
  const Vec3 normal = direction_from_azimuth_zenith(radians_from_degrees(170), radians_from_degrees(30));
  EXPECT_NEAR(degrees_from_radians(std::acos(glm::dot(normal, sun.to_sun()))),
              c["expected"]["incidence"].get<double>(), 1e-2);
}

TEST(SunPosition, EquinoxAndSolsticeStandWhereTheyShould) {
  // At the equator nine hours after the equinox (03:06 UTC) the declination is 9/24 * 0.396 = 0.15 degrees,
  // and at 12:07:30 the sun has passed noon by the equation of time (-7.4 min): overhead within 0.2 degrees.
  const SunPosition noon = sun_position({0, 0, 0, 0, 10}, parse_utc_time("2024-03-20T12:07:30Z", "test"));
  EXPECT_LT(degrees_from_radians(noon.zenith_rad), 0.2);
  // At the pole at the June solstice the elevation is the true obliquity, 23.4361 mean + 0.0024 nutation,
  // less the sun's parallax of 0.0024 cos(23.4) degrees.
  const SunPosition pole = sun_position({90, 0, 0, 0, 10}, parse_utc_time("2024-06-20T20:51Z", "test"));
  EXPECT_NEAR(degrees_from_radians(pole.zenith_rad), 90 - 23.4363, 2e-3);
}

TEST(SunPosition, RefusesWhatIsNoTime) {
  for (const char* text : {"", "yesterday", "2024-13-01T00:00", "2024-06-21", "2024-06-21T25:00Z",
                           "2024-06-21T11:30X", "1600-01-01T00:00Z"}) {
    try {
      parse_utc_time(text, "light.sun.time");
      FAIL() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.where(), "light.sun.time");
      EXPECT_NE(error.remedy().find("2024-06-21T11:30:00Z"), std::string::npos);
    }
  }
}

TEST(Illumination, IsNormalisedOrRefusedWithItsField) {
  const Illumination good{.to_sun = {0, 0, 5}, .bands = {{100, 50}}};
  EXPECT_EQ(checked(good, 1).to_sun, Vec3(0, 0, 1));
  const double nan = std::nan("");
  struct Bad {
    Illumination light;
    const char* where;
  };
  const std::vector<Bad> table = {
      {{.to_sun = {0, 0, 0}, .bands = {{1, 1}}}, "illumination.to_sun"},
      {{.to_sun = {nan, 0, 1}, .bands = {{1, 1}}}, "illumination.to_sun"},
      {{.sun_half_angle_rad = -1, .bands = {{1, 1}}}, "illumination.sun_half_angle_deg"},
      {{.bands = {}}, "illumination.bands"},
      {{.bands = {{-1, 1}}}, "illumination.bands[0].beam_normal_w_m2"},
      {{.sky = SkyModel::kPerez, .bands = {{1, 1}}, .sky_clearness = 0.5}, "illumination.sky_clearness"},
      {{.sky = SkyModel::kPerez, .bands = {{1, 1}}, .sky_clearness = nan}, "illumination.sky_clearness"},
      {{.sky = SkyModel::kPerez, .bands = {{1, 1}}, .sky_brightness = -1}, "illumination.sky_brightness"},
      {{.bands = {{1, nan}}}, "illumination.bands[0].diffuse_horizontal_w_m2"},
  };
  for (const Bad& bad : table) {
    try {
      checked(bad.light, 1);
      FAIL() << bad.where;
    } catch (const Error& error) {
      EXPECT_EQ(error.where(), bad.where);
      EXPECT_FALSE(error.remedy().empty());
    }
  }
}

TEST(Illumination, HasTheSkyOfItsModel) {
  const Vec3 up(0, 0, 1), aside = direction_from_azimuth_zenith(1, 1);
  Illumination light{.to_sun = aside, .bands = {{1, 1}}, .sky_clearness = 7, .sky_brightness = 0.1};
  EXPECT_EQ(sky_radiance(light).radiance(up), 1 / kPi);
  light.sky = SkyModel::kStandardOvercast;
  EXPECT_EQ(sky_radiance(light).radiance(up), relative_sky_radiance(light.sky, 1.0));
  light.sky = SkyModel::kPerez;
  EXPECT_GT(sky_radiance(light).radiance(aside), 3 * sky_radiance(light).radiance(up));
  EXPECT_EQ(to_string(light.sky), "perez");
}

}  // namespace
}  // namespace sunfleck
