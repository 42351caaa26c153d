// Probes against the reference and against closed forms. Both are unbiased, from different random numbers:
// over a scene's elements, the sum of squared differences is the sum of both variances, and the difference of
// the means is as large as its standard error. Seeds are fixed, so the outcome is too.
#include "lighting/trace/probe_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numeric>

#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"
#include "tests/lighting/trace/scenes.h"

namespace sunfleck::test {
namespace {

struct Lit {
  const char* name;
  Forest forest;
  double soil_albedo = 0;
  Illumination light;
};

std::vector<std::size_t> all_elements(const Forest& forest) {
  std::vector<std::size_t> all(ForestIndex(forest).element_count());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

std::vector<ProbeLight> probe(const Forest& forest, double soil_albedo, const Illumination& light,
                              const ProbeOptions& options, bool ground = true) {
  const ProbeScene scene(forest, ground, {});
  const OpticsTable optics = optics_of(forest, soil_albedo);
  return probe_light(scene, optics, checked(light, 1), all_elements(forest), options, {});
}

Forest crown(const Leaf& leaf, std::size_t leaves = 240, double side = 0.16) {
  return forest_of(random_leaves(Crown::kSphere, {0, 0, 1.4}, Vec3(1), leaves, side, 5), {leaf});
}

Forest wooded(const Leaf& leaf) {
  Forest forest = crown(leaf);
  forest.prototypes[0].wood.push_back({{0, 0, 0}, {0, 0, 0.9f}, 0.12f, 0.10f, 0});
  forest.prototypes[0].wood.push_back({{0, 0, 0.9f}, {0.5f, 0.2f, 1.7f}, 0.10f, 0.04f, 0});
  forest.prototypes[0].wood_mesh.push_back({{0, 0, 1.9f}, {0.5f, 0, 1.9f}, {0, 0.5f, 2.1f}, 0});
  forest.instances.push_back({{1.7, 0.3, 0}, {}, 1.1f, 0.9f, {}});
  return forest;
}

// Thin clouds: the reference takes light as even over the volume of a shoot too.
Forest shoots(const Leaf& leaf) {
  RandomStream random(8, 0, RandomPurpose::kTestScene);
  std::vector<FoliageElement> foliage;
  for (int i = 0; i < 700; ++i) {
    const Vec3 centre(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.4, 2));
    foliage.push_back(
        shoot(centre, 0.08 * glm::normalize(Vec3(random.normal(), random.normal(), 0.3)), 0.04, 0.005));
  }
  return forest_of(std::move(foliage), {leaf});
}

// Leaves that repeat, overhang the cell and see their own copies.
Forest periodic(const Leaf& leaf) {
  Forest forest =
      forest_of(random_leaves(Crown::kBox, {0.1, 0.2, 1.0}, {0.5, 0.5, 0.6}, 180, 0.13, 7), {leaf});
  forest.prototypes[0].wood.push_back({{0.45f, 0, 0}, {0.6f, 0.1f, 1.5f}, 0.05f, 0.04f, 0});
  forest.period = Period{{-0.45, -0.35}, {1.05, 1.1}};
  return forest;
}

Forest sloped(Forest forest) {
  forest.terrain.slope_rad = 0.5;
  forest.terrain.aspect_rad = 0.8;
  forest.instances[0].position_m.z = forest.terrain.height_at(0, 0);
  return forest;
}

constexpr Leaf kGreen{0.10, 0.05, 0.1}, kNir{0.45, 0.45, 0.4}, kUneven{0.5, 0.2, 0.3};

std::vector<Lit> scenes() {
  const Vec3 sun(1, 0.4, 1.5);
  Illumination disc = sunlight(sun, 400, 150);
  disc.sun_half_angle_rad = 0.05;
  return {
      {"crown over ground, PAR", crown(kGreen), 0.2, sunlight(sun, 400, 150)},
      {"crown over black ground, NIR", crown(kNir), 0.0, sunlight(sun, 400, 150)},
      {"crown over ground, NIR", crown(kNir), 0.4, sunlight(sun, 400, 150)},
      {"crown under an overcast sky", crown(kNir), 0.2, skylight(100, SkyModel::kStandardOvercast)},
      {"crown in the sun alone, wide disc", crown(kUneven), 0.3, disc},
      {"trees with wood, NIR", wooded(kNir), 0.3, sunlight(sun, 400, 150)},
      {"shoots, NIR", shoots(kNir), 0.3, sunlight(sun, 400, 150)},
      {"periodic layer with wood, NIR", periodic(kNir), 0.3, sunlight(sun, 400, 150)},
      {"crown on a slope", sloped(crown(kUneven)), 0.5, sunlight(sun, 400, 150)},
      {"periodic layer on a slope", sloped(periodic(kUneven)), 0.5, sunlight(sun, 400, 150)},
  };
}

// The reference takes light as even over every leaf, which shifts the mean of these scenes of few large
// leaves by up to 0.8 %: it gets every flat leaf cut into kCuts^2 pieces, whose mean is the leaf's.
constexpr int kCuts = 4;

Forest cut_up(Forest forest) {
  auto& foliage = forest.prototypes[0].foliage;
  std::vector<FoliageElement> pieces;
  for (const FoliageElement& e : foliage) {
    if (e.shape != ElementShape::kParallelogram) {
      pieces.push_back(e);
      continue;
    }
    const Vec3 u = Vec3(e.half_u_m) / double{kCuts}, v = Vec3(e.half_v_m) / double{kCuts};
    for (int i = 0; i < kCuts; ++i)
      for (int j = 0; j < kCuts; ++j)
        pieces.push_back(
            quad(Vec3(e.centre_m) + (2.0 * i + 1 - kCuts) * u + (2.0 * j + 1 - kCuts) * v, u, v));
  }
  foliage = std::move(pieces);
  return forest;
}

struct Truth {
  double irradiance = 0, variance = 0;
};

std::vector<Truth> truth_of_leaves(const BandLightMap& band, std::size_t leaves) {
  const std::size_t pieces = band.elements.size() / leaves;
  std::vector<Truth> truth(leaves);
  for (std::size_t i = 0; i < band.elements.size(); ++i) {
    const ElementLight& e = band.elements[i];
    Truth& t = truth[i / pieces];
    t.irradiance += (static_cast<double>(e.front.total()) + e.back.total()) / static_cast<double>(pieces);
    t.variance += std::pow(band.standard_error_w_m2[i] / static_cast<double>(pieces), 2);
  }
  return truth;
}

struct Agreement {
  double chi2 = 0, mean_z = 0, mean_difference = 0;  // relative
};

Agreement compare(const Lit& scene, int paths, int rays) {
  ReferenceOptions o;
  o.seed = 77;
  o.rays_per_face = o.sun_rays_per_element = rays;
  o.ground_cell_m = 0.25;
  const LightMap map = trace_light(cut_up(scene.forest), scene.soil_albedo, scene.light, o);
  const BandLightMap& band = map.bands[0];
  const auto probes = probe(scene.forest, scene.soil_albedo, scene.light,
                            {.seed = 3, .paths_per_face = paths, .sun_rays = paths});
  const std::vector<Truth> truth = truth_of_leaves(band, probes.size());
  double squares = 0, variances = 0, difference = 0, probe_variance = 0, mean = 0;
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const double d = probes[i].bands[0].irradiance_w_m2() - truth[i].irradiance;
    squares += d * d;
    variances += probes[i].bands[0].variance_w2_m4() + truth[i].variance;
    probe_variance += probes[i].bands[0].variance_w2_m4();
    difference += d;
    mean += truth[i].irradiance;
  }
  const auto n = static_cast<double>(probes.size());
  const double error = std::hypot(std::sqrt(probe_variance) / n, band.mean_irradiance_standard_error_w_m2);
  return {squares / variances, difference / n / error, difference / mean};
}

// chi2: 240 elements or more scatter by 9 % (normal) to 20 % (few bright paths); mean: 3.5 standard errors
// come by chance once in 2000.
TEST(Probes, AgreeWithTheReferenceWithinTheErrorsOfBoth) {
  for (const Lit& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const Agreement a = compare(scene, 256, 64);
    std::printf("%-36s chi2 %.3f, mean %+.2f se (%+.2f %%)\n", scene.name, a.chi2, a.mean_z,
                100 * a.mean_difference);
    EXPECT_GT(a.chi2, 0.75);
    EXPECT_LT(a.chi2, 1.3);
    EXPECT_LT(std::abs(a.mean_z), 3.5);
  }
}

// White leaves, white ground, uniform sky, nothing absorbed in a repeating scene: pi L = 100 on every face.
TEST(Probes, WhiteFurnace) {
  Forest forest = periodic({0.5, 0.5, 1.0});
  const auto probes = probe(forest, 1.0, skylight(100.0), {.paths_per_face = 16});
  for (const ProbeLight& p : probes) {
    EXPECT_NEAR(p.bands[0].front.total(), 100.0, 1e-6);
    EXPECT_NEAR(p.bands[0].back.total(), 100.0, 1e-6);
  }
}

// A lone horizontal leaf high above bright ground: the front gets beam cos + sky, the back what the ground
// gives back, albedo * (beam cos + sky), but for the leaf's shadow: 0.01 m2 seen from 100 m.
TEST(Probes, LoneLeafOverBrightGround) {
  const Forest forest = forest_of({quad({0, 0, 100}, {0.05, 0, 0}, {0, 0.05, 0})});
  const auto p = probe(forest, 0.5, sunlight({1, 0, 1}, 200.0, 100.0), {.paths_per_face = 4000})[0];
  EXPECT_NEAR(p.bands[0].front.direct_w_m2, 200 * std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(p.bands[0].front.sky_w_m2, 100.0, 1e-9);
  EXPECT_NEAR(p.bands[0].back.scattered_w_m2, 0.5 * (200 * std::sqrt(0.5) + 100), 0.1);
  EXPECT_EQ(p.sunlit_fraction, 1.0);
  EXPECT_EQ(p.bands[0].back.direct_w_m2, 0.0);
}

// Without ground nothing comes from below but the sky is still only above.
TEST(Probes, NoGroundGivesNothingFromBelow) {
  const Forest forest = forest_of({quad({0, 0, 1}, {0.05, 0, 0}, {0, 0.05, 0})});
  const auto p = probe(forest, 0.5, skylight(100.0), {}, false)[0];
  EXPECT_EQ(p.bands[0].back.total(), 0.0);
  EXPECT_NEAR(p.bands[0].front.total(), 100.0, 1e-9);
}

// The variance claimed is the variance found: 64 seeds of a 60-leaf crown. Sums over leaves scatter by 5 %.
TEST(Probes, ClaimTheVarianceTheyHave) {
  const Forest forest = crown(kNir, 60, 0.3);
  const ProbeScene scene(forest, true, {});
  const OpticsTable optics = optics_of(forest, 0.3);
  const Illumination light = sunlight({1, 0.4, 1.5}, 400, 150);
  const std::vector<std::size_t> all = all_elements(forest);
  std::vector<double> sum(all.size()), squares(all.size());
  double claimed = 0, found = 0;
  constexpr int kSeeds = 64;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const auto probes = probe_light(scene, optics, light, all, {static_cast<std::uint64_t>(seed), 16, 8}, {});
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double e = probes[i].bands[0].irradiance_w_m2();
      sum[i] += e;
      squares[i] += e * e;
      claimed += probes[i].bands[0].variance_w2_m4() / kSeeds;
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i)
    found += (squares[i] - sum[i] * sum[i] / kSeeds) / (kSeeds - 1.0);
  EXPECT_NEAR(found / claimed, 1.0, 0.15);
}

// A second band on the same paths changes the light of the first by chance only: the bands share their paths.
TEST(Probes, BandsOnOnePathStayUnbiased) {
  const Forest forest = generated_crown({.leaves = 300, .crown_lai = 3, .seed = 4});
  const ProbeScene scene(forest, true, {});
  Illumination light;
  light.to_sun = glm::normalize(Vec3(0.3, 0.2, 1));
  light.bands = {{400, 100}, {400, 100}};
  const OpticsTable both(forest, {{"PAR", "NIR"}, {0.1, 0.3}, {}}), par(forest, {{"PAR"}, {0.1}, {}});
  const auto elements = all_elements(forest);
  const auto two = probe_light(scene, both, light, elements, {.seed = 1, .paths_per_face = 64}, {});
  light.bands.pop_back();
  const auto one = probe_light(scene, par, light, elements, {.seed = 2, .paths_per_face = 64}, {});
  double difference = 0, variance = 0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    difference += two[i].bands[0].irradiance_w_m2() - one[i].bands[0].irradiance_w_m2();
    variance += two[i].bands[0].variance_w2_m4() + one[i].bands[0].variance_w2_m4();
  }
  EXPECT_LT(std::abs(difference), 3.5 * std::sqrt(variance));  // chance 1 in 2000
}

std::vector<double> numbers(const std::vector<ProbeLight>& probes) {
  std::vector<double> all;
  for (const ProbeLight& p : probes)
    for (const ProbeBand& b : p.bands) {
      const auto* first = reinterpret_cast<const double*>(&b);
      all.insert(all.end(), first, first + sizeof(ProbeBand) / sizeof(double));
    }
  return all;
}

TEST(Probes, SameBytesOnAnyNumberOfThreads) {
  const Forest forest = wooded(kNir);
  const Illumination light = sunlight({1, 0.4, 1.5}, 400, 150);
  std::vector<double> one, two;
  with_threads(1, [&] { one = numbers(probe(forest, 0.2, light, {})); });
  with_threads(2, [&] { two = numbers(probe(forest, 0.2, light, {})); });
  ASSERT_EQ(one.size(), two.size());
  EXPECT_EQ(std::memcmp(one.data(), two.data(), one.size() * sizeof(double)), 0);
  EXPECT_NE(one, numbers(probe(forest, 0.2, light, {.seed = 2})));
}

TEST(Probes, RefuseTooFewRaysAndStopWhenAsked) {
  const Forest forest = crown(kGreen);
  for (const ProbeOptions& bad : {ProbeOptions{1, 1, 64}, ProbeOptions{1, 65537, 64}, ProbeOptions{1, 32, 0}})
    try {
      probe(forest, 0.2, skylight(100), bad);
      FAIL();
    } catch (const Error& e) {
      EXPECT_EQ(e.where().rfind("probes.", 0), 0u);
      EXPECT_EQ(e.remedy(), "2 to 65536");
    }
  std::stop_source source;
  const ProbeScene scene(forest, true, {});
  RunControl control{source.get_token(), [&](std::string_view stage, double) {
                       EXPECT_EQ(stage, "probing");
                       source.request_stop();
                     }};
  const OpticsTable optics = optics_of(forest, 0.2);
  const std::vector<std::size_t> elements = all_elements(forest);
  try {
    probe_light(scene, optics, skylight(100), elements, {}, control);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::kCancelled);
  }
}

}  // namespace
}  // namespace sunfleck::test
