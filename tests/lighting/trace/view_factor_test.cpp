// Surfaces that see each other and the sky by factors known in closed form (cases "vf_*", "cone_gap_*",
// "sky_ratio" and "caribu_*" of light_cases.json).
#include <gtest/gtest.h>

#include <cmath>

#include "tests/lighting/trace/golden_cases.h"
#include "tests/lighting/trace/scenes.h"

namespace sunfleck::test {
namespace {

ReferenceOptions no_ground(int rays) {
  ReferenceOptions o;
  o.rays_per_face = rays;
  o.ground = false;
  return o;
}

// A rectangle corner + a * side_u + b * side_v cut into n x n leaves.
void add_plate(std::vector<FoliageElement>& to, const Vec3& corner, const Vec3& side_u, const Vec3& side_v,
               int n, std::uint16_t material = 0) {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      to.push_back(quad(corner + ((i + 0.5) / n) * side_u + ((j + 0.5) / n) * side_v, side_u / (2.0 * n),
                        side_v / (2.0 * n), material));
}

double mean_front(const LightMap& map, std::size_t first, std::size_t count) {
  double sum = 0.0;
  for (std::size_t i = first; i < first + count; ++i) sum += map.bands[0].elements[i].front.total();
  return sum / static_cast<double>(count);
}

// The lower of two facing plates sees the upper one by F12 and the sky by the rest. Relative standard error
// about 0.1 %.
TEST(ViewFactor, ParallelPlates) {
  const auto c = light_case("vf_parallel_1x2_gap0.5");
  std::vector<FoliageElement> plates;
  add_plate(plates, {0, 0, 0}, {1, 0, 0}, {0, 2, 0}, 20);
  add_plate(plates, {0, 0, 0.5}, {1, 0, 0}, {0, 2, 0}, 20);
  const Forest forest = forest_of(plates);
  const LightMap map = trace_light(forest, 0.0, skylight(1.0), no_ground(2048));
  const double expected = c["expected"]["sky_absorbed_per_area_each"];
  EXPECT_NEAR(mean_front(map, 0, 400), expected, 0.005 * expected);
  expect_sound(map, forest);
}

// A vertical black square beside a horizontal one under a vertical beam receives r * beam * F12 and nothing
// of the beam, which passes it edge-on.
TEST(ViewFactor, PerpendicularSquares) {
  const auto c = light_case("vf_perp_unit_squares");
  std::vector<FoliageElement> plates;
  add_plate(plates, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 20, 0);
  add_plate(plates, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 20, 1);  // front towards +x
  const Forest forest = forest_of(plates, {Leaf{0.3, 0.0}, Leaf{}});
  const LightMap map = trace_light(forest, 0.0, sunlight({0, 0, 1}, 1000.0), no_ground(4096));
  double horizontal = 0.0, vertical = 0.0;
  for (std::size_t i = 0; i < 400; ++i) horizontal += map.bands[0].elements[i].absorbed_w;
  for (std::size_t i = 400; i < 800; ++i) vertical += map.bands[0].elements[i].absorbed_w;
  const double expected_horizontal = c["expected"]["absorbed_horizontal"];
  const double expected_vertical = c["expected"]["absorbed_vertical"];
  EXPECT_NEAR(horizontal, expected_horizontal, 1e-4 * expected_horizontal);
  EXPECT_NEAR(vertical, expected_vertical, 0.005 * expected_vertical);
  expect_sound(map, forest);
}

// A ball as a pile of n cone frustums of wood.
void add_ball(Prototype& prototype, const Vec3& centre, double radius, int n) {
  const auto at = [&](int i) { return Vec3f(centre - Vec3(0, 0, radius * std::cos(kPi * i / n))); };
  const auto width = [&](int i) { return static_cast<float>(std::abs(radius * std::sin(kPi * i / n))); };
  for (int i = 0; i < n; ++i) prototype.wood.push_back({at(i), at(i + 1), width(i), width(i + 1), 0});
}

// What a plate receives from a ball that sends out 1 W m-2 everywhere is the part of its hemisphere that the
// ball fills: with a black ball in a sky of 1 it lacks just that.
TEST(ViewFactor, BallOverThePlateCorner) {
  const auto c = light_case("vf_sphere_source_patch");
  std::vector<FoliageElement> plate;
  add_plate(plate, {0, 0, 0}, {1.5, 0, 0}, {0, 2.0, 0}, 40);
  Forest forest = forest_of(plate);
  add_ball(forest.prototypes[0], {0, 0, 0.75}, 0.5, 64);
  ReferenceOptions o = no_ground(4096);
  const LightMap map = trace_light(forest, 0.0, skylight(1.0), o);
  const double expected = c["expected"]["absorbed_per_area"];
  EXPECT_NEAR(1.0 - mean_front(map, 0, 1600), expected, 0.005 * expected);
}

// Sensors at the bottom centre of a black cylinder wall see sin^2 of the gap's half angle of an even sky.
TEST(ViewFactor, ConeGap) {
  for (const char* id : {"cone_gap_r/h=0.5", "cone_gap_r/h=1", "cone_gap_r/h=4"}) {
    const auto c = light_case(id);
    const double height = 1.0,
                 radius = height * std::tan(radians_from_degrees(c["expected"]["gap_half_angle_deg"]));
    std::vector<FoliageElement> sensors;
    add_plate(sensors, Vec3(-5e-4, -5e-4, 0), {1e-3, 0, 0}, {0, 1e-3, 0}, 4);
    Forest forest = forest_of(sensors);
    forest.prototypes[0].wood.push_back({{0, 0, -1e-3f},
                                         {0, 0, static_cast<float>(height)},
                                         static_cast<float>(radius),
                                         static_cast<float>(radius),
                                         0});
    for (const SkyModel sky : {SkyModel::kUniform, SkyModel::kStandardOvercast}) {
      const LightMap map = trace_light(forest, 0.0, skylight(1.0, sky), no_ground(32768));
      const double expected =
          c["expected"][sky == SkyModel::kUniform ? "sky_view_factor_UOC" : "indirect_site_factor_SOC"];
      EXPECT_NEAR(mean_front(map, 0, 16), expected, 0.002) << id;
    }
  }
}

// Zenith radiance 1 puts pi on the horizontal under an even sky and 7 pi / 9 under an overcast one; a leaf in
// the open receives the whole diffuse irradiance on its upper face under both.
TEST(ViewFactor, OpenSky) {
  const auto expected = light_case("sky_ratio")["expected"];
  const double uniform = expected["UOC_horizontal_irradiance"],
               overcast = expected["SOC_horizontal_irradiance"];
  EXPECT_NEAR(1.0 / relative_sky_radiance(SkyModel::kUniform, 1.0), uniform, 1e-4 * uniform);
  EXPECT_NEAR(1.0 / relative_sky_radiance(SkyModel::kStandardOvercast, 1.0), overcast, 1e-4 * overcast);
  const Forest forest = forest_of({quad({0, 0, 1}, {0.1, 0, 0}, {0, 0.1, 0})});
  const LightMap even = trace_light(forest, 0.0, skylight(100.0), no_ground(64));
  EXPECT_NEAR(even.bands[0].elements[0].front.total(), 100.0, 1e-4);
  EXPECT_EQ(even.bands[0].elements[0].back.total(), 0.0);
  const LightMap dull =
      trace_light(forest, 0.0, skylight(100.0, SkyModel::kStandardOvercast), no_ground(65536));
  EXPECT_NEAR(dull.bands[0].elements[0].front.total(), 100.0, 4.0 * dull.bands[0].standard_error_w_m2[0]);
  EXPECT_LT(dull.bands[0].standard_error_w_m2[0], 0.2);
}

// Two sheets 1e-5 m apart: the upper one is lit by 100, the lower by what comes through and the ping-pong
// between them: E_lower = 20 / (1 - 0.1 * 0.1), E_upper = 100 + 0.1 E_lower.
TEST(Caribu, TwoTranslucentTriangles) {
  const auto c = light_case("caribu_two_triangles_translucent");
  const double side = std::sqrt(2.0), gap = c["inputs"]["upper_offset_z"];
  const Forest forest = forest_of({triangle({0, 0, 0}, {side, 0, 0}, {0, side, 0}, 0),
                                   triangle({0, 0, gap}, {side, 0, gap}, {0, side, gap}, 1)},
                                  {Leaf{0.1, 0.0}, Leaf{0.1, 0.2}});
  ReferenceOptions o = no_ground(1024);
  o.convergence = 1e-7;
  const LightMap map = trace_light(forest, 0.0, sunlight({0, 0, 1}, 100.0), o);
  const ElementLight &lower = map.bands[0].elements[0], &upper = map.bands[0].elements[1];
  EXPECT_NEAR(lower.front.total() + lower.back.total(), 20.0 / 0.99, 0.02);
  EXPECT_NEAR(upper.front.total() + upper.back.total(), 100.0 + 2.0 / 0.99, 0.02);
  EXPECT_NEAR(lower.front.total(), c["expected"]["Ei_lower"].get<double>(), 0.5);
  EXPECT_NEAR(upper.front.total() + upper.back.total(), c["expected"]["Ei_upper"].get<double>(), 0.5);
}

TEST(Caribu, InclinedTriangle) {
  const auto c = light_case("caribu_inclined_triangle");
  const Forest forest = forest_of({triangle({0, 0, 0}, {0, std::sqrt(2.0), 0}, {-1, 0, 1})});
  EXPECT_NEAR(forest.prototypes[0].foliage[0].area_m2, c["expected"]["area"].get<double>(), 1e-6);
  const LightMap map = trace_light(forest, 0.0, sunlight({1, 0, 1}, 100.0 * std::sqrt(2.0)), no_ground(64));
  const ElementLight& e = map.bands[0].elements[0];
  EXPECT_NEAR(e.front.total() + e.back.total(), 100.0 * std::sqrt(2.0), 1e-3);
  EXPECT_NEAR(e.front.total() + e.back.total(), c["expected"]["Ei"].get<double>(), 0.5);
}

}  // namespace
}  // namespace sunfleck::test
