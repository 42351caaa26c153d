// The estimators on scenes with closed-form answers, and what every light map must keep.
#include "lighting/slab/spp_estimators.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "tests/lighting/slab/estimator_scene.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

using namespace test;

// A horizontal leaf alone under an open sky: beam * cos(zenith) and all of the diffuse light on its upper
// face, nothing on the lower one, nothing scattered.
TEST(SppEstimators, ALoneLeafGetsAllItsLight) {
  const Forest forest = forest_of({square_leaf({0, 0, 2}, {0.05, 0, 0}, {0, 0.05, 0})});
  const OpticsTable optics = optics_of(forest, 0.4, 0.4);
  for (const SppVariant variant : kAllVariants) {
    const LightMap map = estimate(forest, optics, light_of(sun_at(60), 800, 100), variant);
    const ElementLight& leaf = map.bands[0].elements[0];
    EXPECT_NEAR(leaf.front.direct_w_m2, 400, 1e-3);
    EXPECT_NEAR(leaf.front.sky_w_m2, 100, 1e-3);
    EXPECT_NEAR(leaf.front.scattered_w_m2, 0, 1e-3);
    EXPECT_NEAR(leaf.back.total(), 0, 1e-3);
    EXPECT_NEAR(leaf.absorbed_w, 0.01 * 0.2 * 500, 1e-4);
    EXPECT_NEAR(map.sunlit_fraction[0], 1.0, 1e-6);
  }
}

// A shoot's needles look everywhere alike: a quarter of the beam on each face.
TEST(SppEstimators, AShootGetsAQuarterOfTheBeamOnEachFace) {
  FoliageElement shoot = square_leaf({0, 0, 2}, {0.1, 0, 0}, {0, 0.02, 0});
  shoot.shape = ElementShape::kShoot;
  shoot.area_m2 = 0.01f;
  const Forest forest = forest_of({shoot});
  const LightMap map =
      estimate(forest, optics_of(forest, 0.1, 0.0), light_of(sun_at(30), 800, 0), SppVariant::kSpp);
  EXPECT_NEAR(map.bands[0].elements[0].front.direct_w_m2, 200, 1e-2);
  EXPECT_NEAR(map.bands[0].elements[0].back.direct_w_m2, 200, 1e-2);
}

// Black random leaves, spherical, periodic: absorbed = incident (1 - exp(-L / (2 cos zenith))), Beer's law.
// One random cell of 20,000 leaves: the bound is 3 % of the absorbed light (measured: below 1.5 %).
TEST(SppEstimators, BlackCanopyAbsorbsByBeersLaw) {
  const nlohmann::json cases = golden("light_cases.json");
  int tested = 0;
  for (const auto& c : cases["cases"]) {
    const std::string id = c["id"];
    if (id != "beer_spherical_LAI1" && id != "beer_spherical_LAI2") continue;
    ++tested;
    const Forest forest = generated_layer({c["inputs"]["LAI"], 4.0, 1.0, 20000, 11});
    const OpticsTable optics = optics_of(forest, 0, 0);
    const double ground_m2 = forest.period->size_m.x * forest.period->size_m.y;
    for (const int zenith : {0, 20, 50, 75}) {
      const LightMap map = estimate(forest, optics, light_of(sun_at(zenith), 1000, 0), SppVariant::kSpp);
      const double incident = 1000 * std::cos(radians_from_degrees(zenith)) * ground_m2;
      const double truth = c["expected"]["intercept_direct_sza" + std::to_string(zenith)];
      const double value = absorbed_w(map) / incident;
      std::printf("%s at %d degrees: absorbed %.4f, Beer %.4f (%+.1f %%)\n", id.c_str(), zenith, value, truth,
                  100 * (value / truth - 1));
      EXPECT_NEAR(value, truth, 0.03 * truth);
    }
  }
  EXPECT_EQ(tested, 2);
}

// The same under a uniform sky: absorbed share 1 - 2 E3(L / 2), the diffuse transmittance of a spherical
// canopy; E3 by 2000-point quadrature of t^... : 2 E3(x) = integral of 2 mu exp(-x / mu) over mu in [0, 1].
// Eleven directions stand for the sky: 6 % allowed.
TEST(SppEstimators, BlackCanopyAbsorbsSkyLight) {
  for (const double lai : {1.0, 3.0}) {
    const Forest forest = generated_layer({lai, 4.0, 1.0, 20000, 12});
    double gap = 0.0;
    for (int i = 0; i < 2000; ++i) {
      const double mu = (i + 0.5) / 2000;
      gap += 2 * mu * std::exp(-0.5 * lai / mu) / 2000;
    }
    for (const int directions : {16, 22}) {
      SppOptions options{SppVariant::kSpp, directions, 64, 16, {}};
      const LightMap map =
          spp_light_map(forest, optics_of(forest, 0, 0), light_of(sun_at(30), 0, 100), options, {});
      const double value = absorbed_w(map) / (100 * forest.period->size_m.x * forest.period->size_m.y);
      std::printf("sky, LAI %.0f, %d directions: absorbed %.4f, exact %.4f (%+.1f %%)\n", lai, directions,
                  value, 1 - gap, 100 * (value / (1 - gap) - 1));
      EXPECT_NEAR(value, 1 - gap, 0.06 * (1 - gap));
    }
  }
}

// A periodic layer is a slab: G is near 1, spp_g near spp, and both near the closed form itself. Absorbed
// share of the beam overhead for leaf albedo 0.9, r = t (R = 1/2): net flux in minus net flux out of [SPP]
// Eq. 19.
TEST(SppEstimators, ClosedCanopyFollowsTheClosedForm) {
  const Forest forest = generated_layer({4.0, 4.0, 2.0, 40000, 13});
  const OpticsTable optics = optics_of(forest, 0.45, 0.45);
  const double depth = 2.0, alpha = 0.1;  // LAI / 2
  const double lambda = std::sqrt(alpha * (alpha + 0.9)), r = 0.45 / (0.55 + lambda);
  // Two-stream slab with black ground, R = T = 1/2: up(0) = r (1 - E^2) / (1 - r^2 E^2), E = e^(-lambda W).
  const double across = std::exp(-lambda * depth), loss = 1 - r * r * across * across;
  const double reflected = r * (1 - across * across) / loss, passed = (1 - r * r) * across / loss;
  const double truth = 1 - reflected - passed;
  for (const SppVariant variant : {SppVariant::kSpp, SppVariant::kSppG}) {
    const LightMap map = estimate(forest, optics, light_of({0, 0, 1}, 1000, 0), variant);
    const double value = absorbed_w(map) / (1000 * 16);
    std::printf("closed canopy, %s: absorbed %.4f, slab %.4f\n", map.provenance.method.c_str(), value, truth);
    EXPECT_NEAR(value, truth, variant == SppVariant::kSpp ? 0.02 * truth : 0.15 * truth);
  }
}

// Nothing can absorb more than falls on its silhouette: crowns, any albedo, spherical leaves.
TEST(SppEstimators, AbsorbNoMoreThanFallsOnTheCrown) {
  const Forest forest = generated_crown({CrownKind::kSphere, 3000, 1.0, 5.0, 4});
  for (const double half_albedo : {0.0, 0.25, 0.45, 0.499})
    for (const double zenith : {0.0, 45.0, 85.0})
      for (const SppVariant variant : kVariants) {
        const LightMap map = estimate(forest, optics_of(forest, half_albedo, half_albedo, 0.3),
                                      light_of(sun_at(zenith), 1000, 0), variant);
        // The silhouette of a ball of leaves reaches half a leaf beyond its radius: 1.05^2.
        EXPECT_LE(absorbed_w(map), 1000 * kPi * 1.05 * 1.05) << half_albedo << " " << zenith;
      }
}

Forest small_stand() {
  Forest forest = generated_crown({CrownKind::kSphere, 400, 1.0, 3.0, 8});
  for (int i = 1; i < 5; ++i) {
    Instance tree = forest.instances[0];
    tree.position_m += Vec3(1.8 * i, 0.4 * i, 0.1 * i);
    tree.yaw_rad = static_cast<float>(0.9 * i);
    tree.scale = 1.0f + 0.05f * static_cast<float>(i);
    tree.tree = TreeId{static_cast<std::uint32_t>(i)};
    forest.instances.push_back(tree);
  }
  return forest;
}

// Moving everything by 1e4 m (and 1e6 m): positions are double and only differences are used, which round at
// 1e-10 m; texels are 0.1 m, so nothing changes by more than 1e-5 of the mean.
TEST(SppEstimators, DoNotNoticeWhereTheForestStands) {
  const Forest forest = small_stand();
  for (const double shift : {1e4, 1e6}) {
    Forest moved = forest;
    for (Instance& tree : moved.instances) tree.position_m += Vec3(shift, -2 * shift, 0.01 * shift);
    moved.terrain.elevation_m += 0.01 * shift;
    for (const SppVariant variant : kVariants) {
      const Illumination light = light_of(sun_at(50), 700, 200);
      const OpticsTable optics = optics_of(forest, 0.3, 0.3, 0.2);
      EXPECT_LT(largest_difference(estimate(forest, optics, light, variant),
                                   estimate(moved, optics, light, variant)),
                1e-5);
    }
  }
}

// Turning everything about z: yaws are float (1e-7 rad) and sums are rounded in float (1e-6). Sample
// directions turn with the first tree, so the stated tolerance is 1e-4 of the mean.
TEST(SppEstimators, TurnWithTheForest) {
  const Forest forest = small_stand();
  const double turn = 0.61;
  Forest turned = forest;
  const double c = std::cos(turn), s = std::sin(turn);
  for (Instance& tree : turned.instances) {
    const Vec3 p = tree.position_m;
    tree.position_m = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
    tree.yaw_rad += static_cast<float>(turn);
  }
  const Vec3 sun = sun_at(50);
  const Vec3 turned_sun(c * sun.x - s * sun.y, s * sun.x + c * sun.y, sun.z);
  const OpticsTable optics = optics_of(forest, 0.3, 0.3, 0.2);
  for (const SppVariant variant : kVariants)
    EXPECT_LT(largest_difference(estimate(forest, optics, light_of(sun, 700, 200), variant),
                                 estimate(turned, optics, light_of(turned_sun, 700, 200), variant)),
              1e-4);
}

// Sun plus sky = sun and sky; twice the strength = twice the light. Float sums: 1e-5 of the mean.
TEST(SppEstimators, AreAdditiveAndLinear) {
  const Forest forest = small_stand();
  const OpticsTable optics = optics_of(forest, 0.3, 0.3, 0.2);
  for (const SppVariant variant : kAllVariants) {
    const LightMap sun = estimate(forest, optics, light_of(sun_at(50), 700, 0), variant);
    const LightMap sky = estimate(forest, optics, light_of(sun_at(50), 0, 200), variant);
    const LightMap both = estimate(forest, optics, light_of(sun_at(50), 700, 200), variant);
    const LightMap twice = estimate(forest, optics, light_of(sun_at(50), 1400, 400), variant);
    for (std::size_t e = 0; e < both.bands[0].elements.size(); ++e) {
      const auto total = [e](const LightMap& m) {
        return static_cast<double>(m.bands[0].elements[e].front.total()) +
               m.bands[0].elements[e].back.total();
      };
      ASSERT_NEAR(total(sun) + total(sky), total(both), 1e-5 * both.bands[0].mean_irradiance_w_m2);
      ASSERT_NEAR(total(twice), 2 * total(both), 2e-5 * both.bands[0].mean_irradiance_w_m2);
    }
  }
}

TEST(SppEstimators, GiveTheSameBytesForAnyNumberOfThreads) {
  const Forest forest = small_stand();
  const OpticsTable optics = optics_of(forest, 0.3, 0.3, 0.2);
  const auto run = [&](int threads, SppVariant variant) {
    LightMap map;
    with_threads(threads, [&] { map = estimate(forest, optics, light_of(sun_at(50), 700, 200), variant); });
    return map;
  };
  for (const SppVariant variant : kAllVariants) {
    const LightMap one = run(1, variant), two = run(2, variant);
    const auto& a = one.bands[0].elements;
    const auto& b = two.bands[0].elements;
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]), 0);
    EXPECT_EQ(one.sunlit_fraction, two.sunlit_fraction);
  }
}

// From 256 yaws on, sun maps are shared by yaws within 1/128 turn (2.8 degrees). 300 trees far apart against
// each of them alone, which is never rounded: rounding moves the shadows of single leaves but not their mean,
// whose noise is 1.5 / sqrt(300 * 60) = 1.1 %; twice that is allowed.
TEST(SppEstimators, ShareSunMapsAmongManyYaws) {
  const Forest one = generated_crown({CrownKind::kSphere, 60, 1.0, 3.0, 9});
  Forest many = one;
  many.instances.clear();
  const Illumination light = light_of(sun_at(60), 1000, 0);
  double alone_w = 0.0;
  for (int i = 0; i < 300; ++i) {
    Forest alone = one;
    alone.instances[0].yaw_rad = static_cast<float>(0.017 * i);
    alone_w += absorbed_w(estimate(alone, optics_of(alone, 0, 0), light, SppVariant::kSpp));
    many.instances.push_back(alone.instances[0]);
    many.instances.back().position_m += Vec3(100.0 * i, 0.0, 0.0);
  }
  const LightMap map = estimate(many, optics_of(many, 0, 0), light, SppVariant::kSpp);
  EXPECT_NEAR(absorbed_w(map), alone_w, 0.022 * alone_w);
  const auto& settings = map.provenance.settings;
  const auto maps =
      std::find_if(settings.begin(), settings.end(), [](const auto& s) { return s.first == "sun_maps"; });
  ASSERT_NE(maps, settings.end());
  EXPECT_LE(std::stoi(maps->second), 64);
}

// What the stages are called, and that they are timed.
TEST(SppEstimators, TellTheirStagesAndSettings) {
  const Forest forest = small_stand();
  const LightMap map =
      estimate(forest, optics_of(forest, 0.3, 0.3), light_of(sun_at(50), 700, 200), SppVariant::kSppG);
  std::vector<std::string> stages;
  for (const StageTime& t : map.provenance.times) stages.push_back(t.stage);
  EXPECT_EQ(stages, (std::vector<std::string>{"preprocess", "sky", "sun", "evaluate"}));
  EXPECT_FALSE(map.provenance.settings.empty());
  EXPECT_FALSE(map.bands[0].has_budget);
}

// Without a sun there is nothing direct and nothing sunlit, and the answer says so.
TEST(SppEstimators, HaveNoSunAtNightOrBehindASlope) {
  Forest forest = small_stand();
  const OpticsTable optics = optics_of(forest, 0.3, 0.3);
  const auto dark = [&](const Illumination& light) {
    const LightMap map = estimate(forest, optics, light, SppVariant::kSppG);
    for (const ElementLight& e : map.bands[0].elements)
      ASSERT_EQ(e.front.direct_w_m2 + e.back.direct_w_m2, 0);
    for (const float f : map.sunlit_fraction) ASSERT_EQ(f, 0.0f);
    ASSERT_FALSE(map.provenance.skipped.empty());
  };
  dark(light_of({0.8, 0, -0.6}, 500, 100));
  forest.terrain = {0.0, radians_from_degrees(30), 0.0};  // falls to the north, sun low in the south
  dark(light_of(sun_at(70, 180), 500, 100));
}

TEST(SppEstimators, RefuseBadOptions) {
  const Forest forest = small_stand();
  const OpticsTable optics = optics_of(forest, 0.3, 0.3);
  struct Case {
    SppOptions options;
    std::string where;
  };
  for (const Case& c :
       {Case{{SppVariant::kSpp, 17, 64, 16, {}}, "spp.sample_directions"},
        Case{{SppVariant::kSpp, 22, 7, 16, {}}, "spp.map_resolution"},
        Case{{SppVariant::kSpp, 22, 1025, 16, {}}, "spp.map_resolution"},
        Case{{SppVariant::kSpp, 22, 64, 1, {}}, "spp.grid_resolution"},
        Case{{SppVariant::kSpp, 22, 64, 65, {}}, "spp.grid_resolution"},
        Case{{SppVariant::kSppMarched, 22, 64, 16, {{}, {}, -1.0}}, "spp.marched.cell_m"},
        Case{{SppVariant::kSppMarched, 22, 64, 16, {{}, {}, std::nan("")}}, "spp.marched.cell_m"}}) {
    try {
      spp_light_map(forest, optics, light_of(sun_at(10), 1, 1), c.options, {});
      FAIL() << c.where;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput);
      EXPECT_EQ(error.where(), c.where);
      EXPECT_FALSE(error.problem().empty());
      EXPECT_FALSE(error.remedy().empty());
    }
  }
}

TEST(SppEstimators, StopWhenAsked) {
  const Forest forest = small_stand();
  std::stop_source source;
  source.request_stop();
  try {
    spp_light_map(forest, optics_of(forest, 0.3, 0.3), light_of(sun_at(10), 1, 1), {},
                  {source.get_token(), {}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kCancelled);
  }
}

}  // namespace
}  // namespace sunfleck
