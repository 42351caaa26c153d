// Skies and patches: horizontal irradiance of every model, stability in all weathers, known behaviour of the
// all-weather sky, mean radiance of patches against fine integrals.
#include <gtest/gtest.h>

#include <cmath>

#include "lighting/sky/sky_patches.h"
#include "lighting/sky/sky_radiance.h"

namespace sunfleck {
namespace {

Vec3 sun_at(double azimuth_deg, double zenith_deg) {
  return direction_from_azimuth_zenith(radians_from_degrees(azimuth_deg), radians_from_degrees(zenith_deg));
}

// 46,000 directions of about equal solid angle, not those the normalisation uses.
const HemisphereGrid::Points& fine_points() {
  static const auto points = HemisphereGrid::equal_area(3.0).points(5, 4);
  return points;
}

double horizontal_irradiance(const SkyRadiance& sky) {
  const auto& points = fine_points();
  double sum = 0;
  for (std::size_t i = 0; i < points.direction.size(); ++i)
    sum += sky.radiance(points.direction[i]) * points.direction[i].z * points.solid_angle_sr[i];
  return sum;
}

// 30,000 directions of equal solid angle.
std::vector<Vec3> even_directions() {
  std::vector<Vec3> directions;
  for (int i = 0; i < 150; ++i)
    for (int j = 0; j < 200; ++j)
      directions.push_back(
          direction_from_azimuth_zenith(2 * kPi * (j + 0.5) / 200, std::acos((i + 0.5) / 150)));
  return directions;
}

std::vector<PerezSky> all_weathers() {
  std::vector<PerezSky> skies;
  for (const double zenith : {0.0, 0.5, 30.0, 60.0, 80.0, 89.0, 90.0, 95.0})
    for (const double clearness : {1.0, 1.03, 1.1, 1.3, 1.7, 2.3, 3.5, 5.0, 8.0, 50.0})
      for (const double brightness : {0.0, 0.05, 0.15, 0.3, 0.6, 2.0})
        skies.push_back({sun_at(137, zenith), clearness, brightness});
  return skies;
}

// The goal is 0.2 %. Measured over all weathers, possible or not: 0.03 %.
TEST(SkyRadiance, EveryModelPutsOneOnTheHorizontalPlane) {
  EXPECT_NEAR(horizontal_irradiance(SkyRadiance(SkyModel::kUniform)), 1.0, 1e-12);
  EXPECT_NEAR(horizontal_irradiance(SkyRadiance(SkyModel::kStandardOvercast)), 1.0, 1e-4);
  double worst = 0;
  for (const PerezSky& sky : all_weathers())
    worst = std::max(worst, std::abs(horizontal_irradiance(SkyRadiance(sky)) - 1.0));
  EXPECT_LT(worst, 1e-3);
  RecordProperty("worst", std::to_string(worst));
}

TEST(SkyRadiance, IsFiniteAndNotNegativeInAllWeathersAndDirections) {
  for (const PerezSky& weather : all_weathers()) {
    const SkyRadiance sky(weather);
    for (const double zenith : {0.0, 1e-9, 45.0, 89.0, 89.9999, 90.0 - 1e-9})
      for (const double azimuth : {0.0, 137.0, 317.0}) {
        const double radiance = sky.radiance(sun_at(azimuth, zenith));
        EXPECT_TRUE(std::isfinite(radiance) && radiance >= 0.0 && radiance < 1e3)
            << weather.to_sun.z << " " << weather.clearness << " " << weather.brightness << " " << zenith;
      }
    EXPECT_TRUE(std::isfinite(sky.radiance(weather.to_sun)));
    EXPECT_EQ(sky.radiance({1, 0, 0}), 0.0);
    EXPECT_EQ(sky.radiance({0, 0, -1}), 0.0);
  }
}

TEST(SkyRadiance, ClearSkyGlowsAroundTheSunAndOvercastAtTheZenith) {
  const SkyRadiance clear(PerezSky{sun_at(180, 50), 7.0, 0.1});
  EXPECT_GT(clear.radiance(sun_at(180, 50)), 4 * clear.radiance(sun_at(0, 40)));
  EXPECT_GT(clear.radiance(sun_at(0, 85)), clear.radiance(sun_at(0, 40)));  // the horizon is brighter
  // Overcast, the zenith is about three times as bright as the horizon (Moon and Spencer); this model 1.5 to
  // 4, by sun and brightness.
  const SkyRadiance overcast(PerezSky{sun_at(180, 50), 1.0, 0.2});
  const double ratio = overcast.radiance({0, 0, 1}) / overcast.ring_mean(std::cos(radians_from_degrees(85)));
  EXPECT_GT(ratio, 1.5);
  EXPECT_LT(ratio, 4.0);
}

// [Perez93] Eq. 1 with the coefficients of clearness 1.5 to 1.95 written out by hand, Z = 1, Delta = 0.3:
// a = -0.5484 - 0.6654 + 0.3 (-0.2672 + 0.7117) = -1.08045, b = 0.7234 - 0.6219 + 0.3 (-5.6812 + 2.6297) =
// -0.81395, c = 33.3389 - 18.3 + 0.3 (-62.25 + 52.0781) = 11.98733, d = -3.5 + 0.0016 + 0.3 (1.1477 + 0.1062)
// = -3.12223, e = 0.4659 - 0.3296 + 0.3 (-0.0876 - 0.0329) = 0.10015.
TEST(PerezSky, ShapeIsThatOfThePaper) {
  const PerezShape s = perez_shape({direction_from_azimuth_zenith(0, 1.0), 1.7, 0.3});
  EXPECT_NEAR(s.a, -1.08045, 1e-9);
  EXPECT_NEAR(s.b, -0.81395, 1e-9);
  EXPECT_NEAR(s.c, 11.98733, 1e-9);
  EXPECT_NEAR(s.d, -3.12223, 1e-9);
  EXPECT_NEAR(s.e, 0.10015, 1e-9);
  // Zenith, 1 rad from the sun: (1 + a e^b) (1 + c e^d + e cos^2 1).
  EXPECT_NEAR(perez_relative_radiance(s, 1.0, std::cos(1.0)),
              (1 - 1.08045 * std::exp(-0.81395)) *
                  (1 + 11.98733 * std::exp(-3.12223) + 0.10015 * std::pow(std::cos(1.0), 2)),
              1e-12);
}

// Sun at 60 degrees: air mass 1.994 (Kasten and Young); clearness (600 + 150 + 150 * 1.041 * 1.0472^3) / ...
TEST(PerezSky, ClearnessAndBrightnessFollowTheirDefinition) {
  EXPECT_NEAR(relative_air_mass(0), 1.0, 3e-4);
  EXPECT_NEAR(relative_air_mass(radians_from_degrees(60)), 1.994, 1e-3);
  EXPECT_NEAR(relative_air_mass(0.5 * kPi), 38.0, 0.3);
  const PerezSky sky = perez_sky(sun_at(90, 60), 600, 150, 1361);
  const double turbid = 1.041 * std::pow(kPi / 3, 3);
  EXPECT_NEAR(sky.clearness, (750.0 / 150.0 + turbid) / (1 + turbid), 1e-12);
  EXPECT_NEAR(sky.brightness, 1.994 * 150 / 1361, 2e-4);
  EXPECT_EQ(perez_sky(sun_at(90, 60), 0, 0, 1361).clearness, 1.0);
  EXPECT_EQ(perez_sky(sun_at(90, 95), 50, 5, 1361).clearness, 1.0);
}

TEST(SkyPatches, CoverTheHemisphere) {
  const auto check = [](const HemisphereGrid& grid) {
    double solid_angle = 0, projected = 0;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const Vec3& v = grid.directions().to_source[i];
      solid_angle += grid.directions().solid_angle_sr[i];
      projected += grid.directions().solid_angle_sr[i] * v.z;
      EXPECT_NEAR(glm::length(v), 1.0, 1e-12);
      EXPECT_EQ(grid.patch_of(v), i);
    }
    EXPECT_NEAR(solid_angle, 2 * kPi, 1e-10);
    EXPECT_NEAR(projected, kPi, 1e-10);
    const auto points = grid.points(3, 2);
    for (std::size_t i = 0; i < points.direction.size(); ++i)
      EXPECT_EQ(grid.patch_of(points.direction[i]), i / 6);
    EXPECT_LT(grid.patch_of({0, 1, 0}), grid.size());
    EXPECT_LT(grid.patch_of({1e-300, -1e-300, -1}), grid.size());
    EXPECT_LT(grid.patch_of({0, 0, 1}), grid.size());
  };
  for (const double size : {1.0, 2.5, 6.0, 12.0, 30.0}) check(HemisphereGrid::equal_area(size));
  check(HemisphereGrid::tregenza());
  EXPECT_EQ(HemisphereGrid::tregenza().size(), 145u);
  EXPECT_EQ(HemisphereGrid::equal_area(12).size(), 163u);
  EXPECT_EQ(HemisphereGrid::equal_area(6).size(), 573u);
  EXPECT_EQ(HemisphereGrid::equal_area(2.5).size(), 3298u);
  const HemisphereGrid even = HemisphereGrid::equal_area(6);
  for (const double s : even.directions().solid_angle_sr) EXPECT_NEAR(s, 2 * kPi / 573, 1e-12);
}

// Horizontal irradiance of the patches is 1 by construction (goal 0.2 %); what can err is how it spreads: the
// light on walls facing five ways, against the fine integral. Worst at a clear sky with the sun at 2 degrees:
// measured 4.3 % (163 patches) and 1.1 % (573); with the sun at 50 degrees or more 1.8 and 0.5 %.
TEST(SkyPatches, CarryTheLightOfEverySky) {
  std::vector<SkyRadiance> skies = {SkyRadiance(SkyModel::kUniform),
                                    SkyRadiance(SkyModel::kStandardOvercast)};
  for (const double zenith : {5.0, 40.0, 75.0, 88.0})
    for (const auto& [clearness, brightness] : {std::pair{1.0, 0.2}, {1.4, 0.35}, {3.0, 0.2}, {8.0, 0.1}})
      skies.push_back(SkyRadiance(PerezSky{sun_at(200, zenith), clearness, brightness}));
  const std::vector<Vec3> fine = even_directions();
  double worst_163 = 0, worst_573 = 0;
  for (const SkyRadiance& sky : skies) {
    for (const double size : {12.0, 6.0}) {
      const HemisphereGrid grid = HemisphereGrid::equal_area(size);
      const std::vector<double> radiance = patch_radiance(sky, grid, sky_points(grid));
      const SkyDirections& d = grid.directions();
      double horizontal = 0;
      for (std::size_t p = 0; p < grid.size(); ++p)
        horizontal += radiance[p] * d.solid_angle_sr[p] * d.to_source[p].z;
      EXPECT_NEAR(horizontal, 1.0, 1e-12);
      for (const double facing : {0.0, 90.0, 180.0, 200.0, 270.0}) {
        const Vec3 wall = sun_at(facing, 90);
        double patches = 0, exact = 0;
        for (std::size_t p = 0; p < grid.size(); ++p)
          patches += radiance[p] * d.solid_angle_sr[p] * std::max(0.0, glm::dot(wall, d.to_source[p]));
        for (std::size_t i = 0; i < fine.size(); ++i)
          exact += sky.radiance(fine[i]) * std::max(0.0, glm::dot(wall, fine[i])) * 2 * kPi /
                   static_cast<double>(fine.size());
        double& worst = size > 10 ? worst_163 : worst_573;
        worst = std::max(worst, std::abs(patches / exact - 1.0));
      }
    }
  }
  EXPECT_LT(worst_163, 0.05);
  EXPECT_LT(worst_573, 0.014);
  RecordProperty("worst_wall_163", std::to_string(worst_163));
  RecordProperty("worst_wall_573", std::to_string(worst_573));
}

TEST(SkyRadiance, RingMeanIsTheMeanOverAzimuth) {
  const SkyRadiance sky(PerezSky{sun_at(30, 50), 5.0, 0.12});
  double horizontal = 0;
  constexpr int n = 400;
  for (int i = 0; i < n; ++i) {
    const double mu = (i + 0.5) / n;
    horizontal += 2 * kPi * sky.ring_mean(mu) * mu / n;
  }
  EXPECT_NEAR(horizontal, 1.0, 2e-3);  // its own quadrature: 72 azimuths, 400 heights
}

}  // namespace
}  // namespace sunfleck
