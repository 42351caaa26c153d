// The picture of the sun against closed forms. Seeds are fixed. A fraction of N pixels with a straight border
// errs by about 0.27 sqrt(border) / N^(3/4), which is what the tolerances of 0.01 leave tenfold room for.
#include "lighting/trace/sun_raster.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lighting/trace/probe_light.h"
#include "lighting/trace/raster_lanes.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"
#include "tests/lighting/trace/scenes.h"

namespace sunfleck::test {
namespace {

SunExposure draw(const Forest& forest, const Vec3& to_sun, SunRasterOptions o = {.pixel_m = 0.005},
                 double half_angle_rad = 0.0) {
  return raster_sun(forest, ForestIndex(forest), glm::normalize(to_sun), half_angle_rad, o, {});
}

SunExposure draw(std::vector<FoliageElement> foliage, const Vec3& to_sun, double pixel_m = 0.005) {
  return draw(forest_of(std::move(foliage)), to_sun, {.pixel_m = pixel_m});
}

FoliageElement floor_leaf(double half, double z = 1) { return quad({0, 0, z}, {half, 0, 0}, {0, half, 0}); }

TEST(SunRaster, LoneLeavesAreWhollyLitFromAnySide) {
  for (const Vec3& sun : {Vec3(0, 0, 1), Vec3(1, 0, 1e-6), Vec3(0.3, -0.8, 0.5), Vec3(1, 0, 1)})
    for (const FoliageElement& leaf :
         {floor_leaf(0.1), triangle({0, 0, 1}, {0.3, 0, 1.2}, {0, 0.2, 1}), disc({0, 0, 1}, {1, 2, 1}, 0.1)})
      EXPECT_EQ(draw({leaf}, sun).sunlit_fraction[0], 1.0f);
}

TEST(SunRaster, AParallelLeafShadesItsShare) {
  // Overhead a quarter of the lower leaf; from the side the shadow moves out by 0.5: half of that.
  const std::vector<FoliageElement> pair = {floor_leaf(0.5), floor_leaf(0.25, 2)};
  EXPECT_NEAR(draw(pair, {0, 0, 1}).sunlit_fraction[0], 0.75, 0.01);
  EXPECT_NEAR(draw(pair, {1, 0, 2}).sunlit_fraction[0], 0.875, 0.01);
  EXPECT_EQ(draw(pair, {1, 0, 2}).sunlit_fraction[1], 1.0f);
}

TEST(SunRaster, DiscsAndTrianglesShadeTheirAreas) {
  EXPECT_NEAR(draw({floor_leaf(0.5), disc({0, 0, 2}, {0, 0, 1}, 0.4)}, {0, 0, 1}).sunlit_fraction[0],
              1 - kPi * 0.16, 0.01);
  const auto third = triangle({-0.4, -0.4, 2}, {0.4, -0.4, 2}, {-0.4, 0.4, 2.5});
  EXPECT_NEAR(draw({floor_leaf(0.5), third}, {0, 0, 1}).sunlit_fraction[0], 1 - 0.32, 0.01);
}

TEST(SunRaster, WoodShadesItsOutline) {
  Forest forest = forest_of({floor_leaf(0.5)});
  forest.prototypes[0].wood.push_back({{0, -0.4f, 2}, {0, 0.4f, 2}, 0.2f, 0.1f, 0});
  EXPECT_NEAR(draw(forest, {0, 0, 1}).sunlit_fraction[0], 1 - 0.8 * 0.3, 0.01);  // a trapezium
  forest.prototypes[0].wood[0] = {{0, 0, 1.5f}, {0, 0, 3}, 0.2f, 0.1f, 0};
  // A pipe without lids seen along its axis: its wall covers the ring between both radii.
  EXPECT_NEAR(draw(forest, {0, 0, 1}).sunlit_fraction[0], 1 - kPi * (0.04 - 0.01), 0.01);
}

TEST(SunRaster, ShootsDimTheBeamAsBeerSays) {
  const double radius = 0.1, length = 0.3, needles = 0.06;
  const double depth = 0.5 * needles / (kPi * radius * radius);  // along the axis
  const auto cloud = shoot({0, 0, 2}, {0, 0, length / 2}, radius, needles);
  const auto one = draw({floor_leaf(0.25), cloud}, {0, 0, 1});
  EXPECT_NEAR(one.sunlit_fraction[1], -std::expm1(-depth) / depth, 1e-4);
  EXPECT_NEAR(one.sunlit_fraction[0], 1 + kPi * radius * radius / 0.25 * std::expm1(-depth), 0.01);
  // Two in the same place dim each other at every depth.
  const auto two = draw({cloud, cloud}, {0, 0, 1});
  EXPECT_NEAR(two.sunlit_fraction[0], -std::expm1(-2 * depth) / (2 * depth), 1e-4);
  EXPECT_NEAR(two.sunlit_fraction[1], two.sunlit_fraction[0], 1e-6);
  // A leaf half way through a shoot sees half of it.
  const auto within = draw({disc({0, 0, 2}, {0, 0, 1}, 0.05), cloud}, {0, 0, 1});
  EXPECT_NEAR(within.sunlit_fraction[0], std::exp(-depth / 2), 1e-4);
}

// Mean sunlit fraction of leaves turned any way: (1 - exp(-K)) / K, K = LAI / (2 cos zenith). Leaves of a
// layer of 1 m2 cover it in pieces, which scatters by about 2 %.
TEST(SunRaster, PeriodicLayersFollowBeer) {
  for (const double lai : {0.5, 2.0, 6.0})
    for (const Vec3& sun : {Vec3(0, 0, 1), Vec3(1, 0.3, 1), Vec3(1, 0, 0.15)}) {
      const Forest forest = generated_layer({.lai = lai, .leaves = 20000});
      const SunExposure e = draw(forest, sun, {.pixel_m = 0.002});
      double mean = 0;
      for (std::size_t i = 0; i < e.sunlit_fraction.size(); ++i) {
        const double beam = beam_on_faces(forest, 0, i, glm::normalize(sun)).both();
        mean += 2 * beam * e.sunlit_fraction[i] / static_cast<double>(e.sunlit_fraction.size());
      }
      const double k = lai / (2 * glm::normalize(sun).z);
      EXPECT_NEAR(mean / (-std::expm1(-k) / k), 1, 0.03) << lai << " " << sun.z;
    }
}

TEST(SunRaster, GroundShadesFromBehindAndBelow) {
  Forest forest = forest_of({floor_leaf(0.1, 1), floor_leaf(0.1, -1), floor_leaf(0.1, 0)});
  const SunExposure flat = draw(forest, {1, 0, 1});
  EXPECT_EQ(flat.sunlit_fraction[0], 1.0f);
  EXPECT_EQ(flat.sunlit_fraction[1], 0.0f);
  EXPECT_EQ(flat.sunlit_fraction[2], 1.0f);  // lies on it
  EXPECT_EQ(draw(forest, {1, 0, 1}, {.pixel_m = 0.005, .ground = false}).sunlit_fraction[1], 1.0f);
  forest.terrain.slope_rad = 0.5;  // falls to the north: a low southern sun is behind it
  EXPECT_EQ(draw(forest, {0, -1, 0.2}).sunlit_fraction[0], 0.0f);
  EXPECT_EQ(draw(forest, {0, 1, 0.2}).sunlit_fraction[0], 1.0f);
}

TEST(SunRaster, BelowTheHorizonAllIsDark) {
  const SunExposure e = draw({floor_leaf(0.1)}, {1, 0, -0.1});
  EXPECT_EQ(e.sunlit_fraction[0], 0.0f);
  EXPECT_EQ(e.standard_error[0], 0.0f);
}

// Leaves smaller than a pixel, and edge-on ones, are looked up at a point: right on average.
TEST(SunRaster, LeavesBetweenPixelsAreLookedUp) {
  std::vector<FoliageElement> leaves;
  for (int i = 0; i < 400; ++i)
    leaves.push_back(
        quad({-0.475 + 0.05 * (i % 20), -0.475 + 0.05 * (i / 20), 1}, {0.001, 0, 0}, {0, 0.001, 0}));
  leaves.push_back(quad({-0.25, 0, 1.5}, {0.25, 0, 0}, {0, 1, 0}));  // over half of them
  const SunExposure e = draw(leaves, {0, 0, 1}, 0.02);
  double mean = 0;
  for (int i = 0; i < 400; ++i) mean += e.sunlit_fraction[static_cast<std::size_t>(i)] / 400.0;
  EXPECT_NEAR(mean, 0.5, 0.03);
}

// The edge of a wide shade d above a leaf: fraction of the disc seen from x aside of it,
// 1/2 + (x sqrt(1 - x^2) + asin x) / pi for x in radii of the penumbra d tan(half angle).
TEST(SunRaster, PenumbraOfAStraightEdgeAsTheReferenceAndProbesSeeIt) {
  const double half_angle = radians_from_degrees(0.265), distance = 20,
               radius = distance * std::tan(half_angle);
  for (const double x : {-0.8, -0.4, 0.0, 0.5, 0.9}) {
    const double centre = x * radius;
    const Forest forest = forest_of({quad({centre, 0, 1}, {1e-3, 0, 0}, {0, 0.05, 0}),
                                     quad({-0.25, 0, 1 + distance}, {0.25, 0, 0}, {0, 0.25, 0})});
    const SunExposure e = draw(forest, {0, 0, 1}, {.pixel_m = 0.001, .sun_directions = 128}, half_angle);
    const double seen = 0.5 + (x * std::sqrt(1 - x * x) + std::asin(x)) / kPi;
    // Shadow rays of the reference and of probes: 2000 outcomes scatter by 0.011.
    Illumination light = sunlight({0, 0, 1}, 1);
    light.sun_half_angle_rad = half_angle;
    const LightMap map = trace_light(forest, 0, light, {.rays_per_face = 2, .sun_rays_per_element = 2000});
    EXPECT_NEAR(map.bands[0].elements[0].front.direct_w_m2, seen, 0.045) << x;
    const ProbeScene scene(forest, true, {});
    const auto probes = probe_light(scene, optics_of(forest, 0), checked(light, 1),
                                    std::vector<std::size_t>{0}, {.paths_per_face = 2, .sun_rays = 2000}, {});
    EXPECT_NEAR(probes[0].bands[0].front.direct_w_m2, seen, 0.045) << x;
    EXPECT_NEAR(e.sunlit_fraction[0], seen, 0.03) << x;
    EXPECT_LT(e.standard_error[0], 0.06);
  }
}

TEST(SunRaster, SameBytesForAnyThreadsAndAnyMemory) {
  Forest forest = generated_crown({.leaves = 4000, .crown_lai = 3});
  forest.prototypes[0].foliage[7] = shoot({0, 0, 1.5}, {0.2, 0, 0}, 0.1, 0.05);
  forest.instances.push_back({{1.2, 0.4, 0}, {}, 1.0f, 0.8f, {}});
  const SunRasterOptions o{.pixel_m = 0.004, .sun_directions = 2};
  SunExposure one, two;
  with_threads(1, [&] { one = draw(forest, {1, 0.3, 1}, o, 0.005); });
  with_threads(2, [&] { two = draw(forest, {1, 0.3, 1}, o, 0.005); });
  EXPECT_EQ(one.sunlit_fraction, two.sunlit_fraction);
  EXPECT_EQ(one.standard_error, two.standard_error);
  SunRasterOptions narrow = o;
  narrow.memory_limit_bytes = 50000;
  const SunExposure parts = draw(forest, {1, 0.3, 1}, narrow, 0.005);
  EXPECT_EQ(parts.sunlit_fraction, one.sunlit_fraction);
  EXPECT_EQ(parts.standard_error, one.standard_error);
}

TEST(SunRaster, FarFromTheOriginNothingChanges) {
  Forest forest = generated_crown({.leaves = 2000, .crown_lai = 3});
  const SunExposure here = draw(forest, {1, 0.3, 1}, {.pixel_m = 0.01});
  forest.instances[0].position_m += Vec3(1e6, -1e6, 0);
  const SunExposure there = draw(forest, {1, 0.3, 1}, {.pixel_m = 0.01});
  double worst = 0;
  for (std::size_t e = 0; e < here.sunlit_fraction.size(); ++e)
    worst = std::max<double>(worst, std::abs(here.sunlit_fraction[e] - there.sunlit_fraction[e]) *
                                        (here.standard_error[e] < 0.1f ? 1 : 0));
  EXPECT_LT(worst, 0.2);  // a pixel here or there
}

TEST(SunRaster, LanesDoWhatTheirPlainTwinsDo) {
  using namespace trace;
  RandomStream random(3, 0, RandomPurpose::kTestScene);
  for (int round = 0; round < 200; ++round) {
    std::vector<float> depth(80), depth_plain;
    std::vector<std::uint32_t> shown(80), other(80), shown_plain;
    for (std::size_t i = 0; i < 80; ++i) {
      depth[i] = static_cast<float>(random.uniform());
      shown[i] = random.below(3), other[i] = random.below(3);
    }
    depth_plain = depth, shown_plain = shown;
    const auto count = static_cast<std::int32_t>(random.below(65));
    const auto s = static_cast<float>(random.uniform()), step = static_cast<float>(0.1 * random.normal());
    draw_run(depth.data(), shown.data(), count, s, step, 2);
    draw_run_plain(depth_plain.data(), shown_plain.data(), count, s, step, 2);
    EXPECT_EQ(shown, shown_plain);
    // One rounding of a fused product may differ.
    for (std::size_t i = 0; i < 80; ++i) EXPECT_NEAR(depth[i], depth_plain[i], 1e-5);
    LaneCount seen, changes;
    seen.add_seen(shown.data(), count, 2);
    changes.add_changes(shown.data(), other.data(), count, 2);
    EXPECT_EQ(seen.total(), seen_plain(shown.data(), count, 2));
    EXPECT_EQ(changes.total(), changes_plain(shown.data(), other.data(), count, 2));
  }
}

TEST(SunRaster, BadOptionsAreRefused) {
  const Forest forest = forest_of({floor_leaf(0.1)});
  for (const SunRasterOptions& o : {SunRasterOptions{.target_error = 0},
                                    {.target_error = NAN},
                                    {.target_error = 2},
                                    {.pixel_m = -1},
                                    {.pixel_m = INFINITY},
                                    {.sun_directions = -1},
                                    {.sun_directions = 5000}})
    EXPECT_THROW(draw(forest, {0, 0, 1}, o), Error);
}

TEST(SunRaster, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  const Forest forest = forest_of({floor_leaf(0.1)});
  EXPECT_THROW(raster_sun(forest, ForestIndex(forest), {0, 0, 1}, 0, {}, {stop.get_token(), {}}), Error);
}

}  // namespace
}  // namespace sunfleck::test
