// Scenes whose light is known on paper, by the links method.
#include <gtest/gtest.h>

#include "tests/lighting/links/links_light.h"

namespace sunfleck::test {
namespace {

// Two facing unit squares a unit apart: view factor 0.19982 (Howell, catalogue C-11). The lower one sees the
// rest of the sky. 24 seeds: their standard error is asked, and at most 1 % of the value.
TEST(LinksScenes, ParallelSquares) {
  const Forest forest =
      forest_of({quad({0, 0, 1}, {0.5, 0, 0}, {0, 0.5, 0}), quad({0, 0, 2}, {0.5, 0, 0}, {0, 0.5, 0})});
  std::vector<double> seen;
  for (std::uint64_t seed = 1; seed <= 24; ++seed)
    seen.push_back(links_light(forest, 0, skylight(1), {.seed = seed, .ground = false})
                       .bands[0]
                       .elements[0]
                       .front.sky_w_m2);
  const Moments m = moments(seen);
  EXPECT_LT(m.standard_error, 0.01);
  EXPECT_NEAR(m.mean, 1 - 0.19982, 5 * m.standard_error);
}

// A tree of two level unit squares a unit apart, and a second one of it half a unit higher: its lower leaf
// stands between the first one's two. What the first one's upper leaf radiates down is cut, all of it; the
// leaf that cuts it is half a unit off: view factor 0.41525, and light goes to and fro between the two.
TEST(LinksScenes, NeighbourCutsLinksWithinATree) {
  Forest forest =
      forest_of({quad({0, 0, 1}, {0.5, 0, 0}, {0, 0.5, 0}), quad({0, 0, 2}, {0.5, 0, 0}, {0, 0.5, 0})},
                {Leaf{0.6, 0.0}});
  forest.instances.push_back({{0, 0, 0.5}, {}, 0, 1, {}});
  const OpticsTable optics = optics_of(forest, 0);
  const double factor = 0.41525, exact = factor * 0.6 / (1 - 0.36 * factor * factor);
  double mean = 0.0;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const LinksOptions options{.seed = seed, .convergence = 1e-6, .ground = false};
    const LinksPrepared prepared = prepare_links(forest, options, {});
    const auto lower_leaf_lit_from = [&](std::size_t source_face) {
      links::DirectLight direct{std::vector<float>(8), std::vector<float>(4)};
      direct.on_face[source_face] = 1;
      return links_light_map(forest, optics, sunlight({0, 0, 1}, 1), options, prepared, direct, {})
          .bands[0]
          .elements[0]
          .front.scattered_w_m2;
    };
    EXPECT_NEAR(lower_leaf_lit_from(3), 0.0, 1e-6);  // back of the own upper leaf; rounding of its sums
    mean += lower_leaf_lit_from(5) / 16.0;           // back of the neighbour's lower leaf
  }
  EXPECT_NEAR(mean, exact, 0.03 * exact);  // 16 x 64 rays: sqrt(0.58 / 0.42 / 1024) = 3.7 % were they random
}

// Nothing absorbs: light is the same everywhere, whatever stands there. Discs, triangles, shoots, open stems,
// wood meshes, unlike faces, and instances turned and scaled, alone or repeated, sharing a prototype or not.
TEST(LinksScenes, Furnace) {
  Forest forest =
      forest_of(random_leaves(Crown::kSphere, {0, 0, 2}, Vec3(1), 300, 0.15, 5), {Leaf{0.7, 0.3, 1.0}});
  Prototype& tree = forest.prototypes[0];
  for (int i = 0; i < 20; ++i) {
    tree.foliage.push_back(disc({0.1 * i - 1, 0.3, 2}, {0.3, 0.1 * i - 1, 1}, 0.1));
    tree.foliage.push_back(shoot({0.1 * i - 1, -0.3, 2.2}, {0.1, 0.05, 0}, 0.04, 0.03));
    tree.foliage.push_back(triangle({0.1 * i - 1, 0, 1}, {0.1 * i - 0.8, 0.1, 1}, {0.1 * i - 1, 0.2, 1.1}));
  }
  tree.wood.push_back({{0, 0, 0}, {0, 0, 1}, 0.1f, 0.05f, 0});
  tree.wood_mesh.push_back({{0, 0, 2.5f}, {0.3f, 0, 2.5f}, {0, 0.3f, 2.6f}, 0});
  forest.prototypes.push_back(forest.prototypes[0]);
  forest.instances = {{{0, 0, 0}, {}, 0.0f, 1.0f, {}},
                      {{1.5, 0.4, 0}, {}, 2.0f, 0.6f, {}},
                      {{-1, 1, 0}, {1}, 1.0f, 0.8f, {}}};
  for (const bool periodic : {false, true}) {
    if (periodic) forest.period = Period{{-1, -1}, {3, 2}};
    const LightMap map = links_light(forest, 1.0, skylight(1.0),
                                     {.links_per_face = 16, .convergence = 1e-7, .max_iterations = 2000});
    double worst = 0.0;
    for (const ElementLight& e : map.bands[0].elements)
      for (const FaceLight& f : {e.front, e.back}) worst = std::max(worst, std::abs(f.total() - 1.0));
    EXPECT_LT(worst, 1e-5);  // sums of single-precision numbers, 100 bounces deep
    EXPECT_EQ(find_violation(map, ForestIndex(forest)), "");
    EXPECT_NEAR(map.bands[0].budget.absorbed_foliage_w, 0.0, 1e-5 * map.bands[0].budget.incident_w);
  }
}

// A level leaf over a grey plain: sky above, and from below the ground it does not shade much: 1 m up, 1 cm
// wide, it hides 3e-5 of it.
TEST(LinksScenes, OneLeafAlone) {
  const Forest forest = forest_of({quad({0, 0, 1}, {0.005, 0, 0}, {0, 0.005, 0})});
  const LightMap map = links_light(forest, 0.3, sunlight({0.5, 0, 1}, 500, 100));
  const ElementLight& leaf = map.bands[0].elements[0];
  const double beam = 500 / std::sqrt(1.25);
  EXPECT_NEAR(leaf.front.direct_w_m2, beam, 1e-3);
  EXPECT_NEAR(leaf.front.sky_w_m2, 100, 1e-4);
  EXPECT_EQ(leaf.back.direct_w_m2, 0);
  EXPECT_NEAR(leaf.back.scattered_w_m2, 0.3 * (beam + 100), 1e-3 * beam);
  EXPECT_EQ(map.sunlit_fraction[0], 1.0f);
}

// Upright, it sees half a sky and half a ground on both sides; the overcast sky is brighter above: a vertical
// plane gets 3/7 (1/2 + 4/(3 pi)) of it (Moon and Spencer 1942). The looked-up directions err by chance.
TEST(LinksScenes, UprightLeafUnderTwoSkies) {
  const Forest forest = forest_of({quad({0, 0, 1}, {0.005, 0, 0}, {0, 0, 0.005})});
  const double overcast = 3.0 / 7.0 * (0.5 + 4.0 / (3.0 * kPi));
  for (const auto& [sky, exact] :
       {std::pair{SkyModel::kUniform, 0.5}, {SkyModel::kStandardOvercast, overcast}}) {
    const ElementLight leaf =
        links_light(forest, 0, skylight(1, sky), {.links_per_face = 256}).bands[0].elements[0];
    EXPECT_NEAR(leaf.front.sky_w_m2, exact, 0.01 * exact);
    EXPECT_NEAR(leaf.back.sky_w_m2, exact, 0.01 * exact);
  }
}

// A clear Perez sky is brighter around the sun: an upright leaf gets more on the side of it. Midpoint sums
// over 400 x 800 directions; the looked-up ones err by chance.
TEST(LinksScenes, SkyThatIsNotRound) {
  const Forest forest = forest_of({quad({0, 0, 1}, {0, 0.005, 0}, {0, 0, 0.005})});  // front towards +x
  Illumination light = sunlight({1, 0.3, 0.8}, 0, 1);
  light.sky = SkyModel::kPerez;
  light.sky_clearness = 4;
  const SkyRadiance sky = sky_radiance(light);
  double front = 0.0, back = 0.0;
  for (int i = 0; i < 400 * 800; ++i) {
    const double z = (i / 800 + 0.5) / 400, turn = 2 * kPi * (i % 800 + 0.5) / 800,
                 across = std::sqrt(1 - z * z);
    const Vec3 d(across * std::cos(turn), across * std::sin(turn), z);
    (d.x > 0 ? front : back) += std::abs(d.x) * sky.radiance(d) * 2 * kPi / (400 * 800);
  }
  ASSERT_GT(front, 1.3 * back);
  const ElementLight leaf = links_light(forest, 0, light, {.links_per_face = 256}).bands[0].elements[0];
  EXPECT_NEAR(leaf.front.sky_w_m2, front, 0.02 * front);
  EXPECT_NEAR(leaf.back.sky_w_m2, back, 0.02 * back);
}

// Leaves in one place: nobody knows which is on top, but no light is made.
TEST(LinksScenes, CoincidentLeaves) {
  std::vector<FoliageElement> leaves(5, quad({0, 0, 1}, {0.1, 0, 0}, {0, 0.1, 0}));
  const Forest forest = forest_of(std::move(leaves), {Leaf{0.4, 0.4}});
  const LightMap map = links_light(forest, 0.2, sunlight({0, 0.3, 1}, 100, 100));
  EXPECT_EQ(find_violation(map, ForestIndex(forest)), "");
  const EnergyBudget& b = map.bands[0].budget;
  EXPECT_LE(b.absorbed_foliage_w + b.absorbed_ground_w + b.escaped_w, 1.02 * b.incident_w);
}

}  // namespace
}  // namespace sunfleck::test
