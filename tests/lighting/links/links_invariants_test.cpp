// What holds for every answer of the links method.
#include <gtest/gtest.h>

#include "sim/base/parallel.h"
#include "tests/lighting/links/links_light.h"

namespace sunfleck::test {
namespace {

const LinksOptions kTight{.convergence = 1e-6};

Forest small_stand() {
  Forest forest = small_crown();
  forest.instances = {{{0, 0, 0}, {}, 0.3f, 1.0f, {}},
                      {{1.8, 0.2, 0}, {}, 2.0f, 0.8f, {}},
                      {{0.5, 2.1, 0}, {}, 4.0f, 1.1f, {}}};
  return forest;
}

// Light given back and received balances on average; the rest is noise of 1,200 faces with 64 links: about
// 1 / sqrt(80,000) of what is scattered, several bounces deep.
TEST(LinksInvariants, EnergyAddsUp) {
  for (const bool periodic : {false, true}) {
    Forest forest = small_stand();
    if (periodic) forest.period = Period{{-1, -1}, {3.5, 4}};
    const LightMap map = links_light(forest, 0.3, sunlight({0.3, 0.5, 1}, 400, 100), kTight);
    const EnergyBudget& b = map.bands[0].budget;
    EXPECT_EQ(find_violation(map, ForestIndex(forest)), "");
    EXPECT_NEAR(b.incident_w,
                b.absorbed_foliage_w + b.absorbed_wood_w + b.absorbed_ground_w + b.escaped_w + b.residual_w,
                1e-9 * b.incident_w);
    // In a periodic scene direct sun by 16 rays per surface adds 1 %.
    EXPECT_LT(std::abs(b.residual_w), (periodic ? 0.02 : 0.005) * b.incident_w);
  }
}

// Light from A to B is light from B to A (areas counted), all bounces and both ways through a crown. Direct
// light is put on one leaf alone. 16 seeds; what they disagree by is the noise.
TEST(LinksInvariants, Reciprocity) {
  const Forest forest = small_crown(200, {0.5, 0.4});
  const OpticsTable optics = optics_of(forest, 0.2);
  const std::size_t a = 11, b = 140;
  std::vector<double> difference, sum;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const LinksOptions options{.seed = seed, .convergence = 1e-6};
    const LinksPrepared prepared = prepare_links(forest, options, {});
    const auto from_to = [&](std::size_t source, std::size_t target) {
      links::DirectLight direct{std::vector<float>(prepared.receivers->face_count()),
                                std::vector<float>(prepared.receivers->foliage_count())};
      direct.on_face[2 * source] = 1;
      const LightMap map =
          links_light_map(forest, optics, sunlight({0, 0, 1}, 1000), options, prepared, direct, {});
      // Gained by the front of the target as a sensor that was the source: scattered light only.
      const double beam = 1000.0 * prepared.receivers->area_m2(source);
      const ElementLight& e = map.bands[0].elements[target];
      // The source radiates 0.5 from its front and 0.4 from its back; the target weighs its faces alike.
      return prepared.receivers->area_m2(target) *
             (0.5 * e.front.scattered_w_m2 + 0.4 * e.back.scattered_w_m2) / beam;
    };
    const double there = from_to(a, b), back = from_to(b, a);
    difference.push_back(there - back);
    sum.push_back(0.5 * (there + back));
  }
  const Moments d = moments(difference), s = moments(sum);
  EXPECT_GT(s.mean, 0.0);
  EXPECT_LT(std::abs(d.mean), 4 * d.standard_error);  // t with 15 degrees: 1e-3
  EXPECT_LT(d.standard_error, 0.1 * s.mean);          // and that says something
}

TEST(LinksInvariants, SourcesAddUpAndScale) {
  const Forest forest = small_stand();
  const OpticsTable optics = optics_of(forest, 0.3);
  const LinksPrepared prepared = prepare_links(forest, kTight, {});
  const Vec3 sun(0.3, 0.5, 1);
  const auto light = [&](double beam, double sky) {
    return links_light_map(forest, optics, sunlight(sun, beam, sky), kTight, prepared, {});
  };
  const LightMap both = light(400, 100), beam = light(400, 0), sky = light(0, 100), more = light(0, 1e6);
  for (std::size_t i = 0; i < both.bands[0].elements.size(); ++i) {
    const double all = received(both.bands[0].elements[i]);
    EXPECT_NEAR(received(beam.bands[0].elements[i]) + received(sky.bands[0].elements[i]), all, 1e-4 * all);
    EXPECT_NEAR(received(more.bands[0].elements[i]), 1e4 * received(sky.bands[0].elements[i]), 10);
  }
}

// The same rays turn with the tree: what differs is a ray in thousands that rounding sends past an edge
// (1e-7 of the scene against leaves of 0.1), and its share of one leaf's 128.
TEST(LinksInvariants, TurnedAndFarAway) {
  const Forest forest = small_stand();
  const Vec3 sun(0.3, 0.5, 1);
  const LightMap here = links_light(forest, 0.3, sunlight(sun, 400, 100), kTight);
  Forest far = forest;
  for (Instance& i : far.instances) i.position_m += Vec3(1e4, -1e4, 300);
  far.terrain.elevation_m = 300;
  EXPECT_LT(relative_rms(links_light(far, 0.3, sunlight(sun, 400, 100), kTight), here, diffuse), 3e-3);

  Forest turned = forest;
  const double turn = kPi / 2;  // so that ground cells turn onto ground cells
  const auto about_z = [&](const Vec3& v) {
    return Vec3(std::cos(turn) * v.x - std::sin(turn) * v.y, std::sin(turn) * v.x + std::cos(turn) * v.y,
                v.z);
  };
  for (Instance& i : turned.instances)
    i.position_m = about_z(i.position_m), i.yaw_rad += static_cast<float>(turn);
  // Ground cells keep their numbers and so get each other's rays: noise of the ground remains.
  EXPECT_LT(relative_rms(links_light(turned, 0.3, sunlight(about_z(sun), 400, 100), kTight), here, diffuse),
            1e-2);
}

TEST(LinksInvariants, AnyNumberOfThreads) {
  const Forest forest = small_stand();
  const auto run = [&](int threads) {
    LightMap map;
    with_threads(threads, [&] { map = links_light(forest, 0.3, sunlight({0.3, 0.5, 1}, 400, 100)); });
    return map;
  };
  const LightMap one = run(1), three = run(3);
  for (std::size_t i = 0; i < one.bands[0].elements.size(); ++i) {
    EXPECT_EQ(received(one.bands[0].elements[i]), received(three.bands[0].elements[i]));
    EXPECT_EQ(one.sunlit_fraction[i], three.sunlit_fraction[i]);
  }
  EXPECT_EQ(one.bands[0].budget.residual_w, three.bands[0].budget.residual_w);
}

// One call, and its parts with everything kept: the same light; another sun and band needs no links.
TEST(LinksInvariants, PartsGiveTheWhole) {
  const Forest forest = small_stand();
  const OpticsTable optics = optics_of(forest, 0.3);
  const LinksPrepared prepared = prepare_links(forest, {}, {});
  for (const Vec3& sun : {Vec3(0.3, 0.5, 1), Vec3(-1, 0, 0.2)}) {
    const Illumination light = sunlight(sun, 400, 100);
    const LightMap whole = links_light(forest, 0.3, light);
    const LightMap parts = links_light_map(forest, optics, light, {}, prepared,
                                           links_direct_light(prepared, checked(light, 1), {}, {}), {});
    for (std::size_t i = 0; i < whole.bands[0].elements.size(); ++i)
      EXPECT_EQ(received(whole.bands[0].elements[i]), received(parts.bands[0].elements[i]));
  }
}

// From nothing to the furnace, the iteration ends, and more is given back by brighter leaves.
TEST(LinksInvariants, ConvergesForEveryAlbedo) {
  double before = -1;
  for (const double albedo : {0.0, 1e-9, 1e-3, 0.5, 0.9, 0.99, 1.0}) {
    const Forest forest = small_crown(600, {0.5 * albedo, 0.5 * albedo});
    const LightMap map = links_light(forest, albedo, sunlight({0, 0.2, 1}, 300, 100), {.convergence = 1e-5});
    EXPECT_EQ(find_violation(map, ForestIndex(forest)), "");
    EXPECT_TRUE(map.provenance.notes.empty()) << map.provenance.notes[0];
    EXPECT_GT(map.bands[0].mean_irradiance_w_m2, before);
    before = map.bands[0].mean_irradiance_w_m2 * (1 - 1e-9);
  }
}

}  // namespace
}  // namespace sunfleck::test
