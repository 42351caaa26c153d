// Shadow masks against their acceptance numbers (design sheet 7.7) and against rays through the same crown: a
// ball of 40,000 random leaves, crown LAI 5, one sun.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <set>

#include "lighting/shade/cube_mask.h"
#include "lighting/shade/shadow_tile.h"
#include "lighting/trace/ray_scene.h"
#include "sim/base/error.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

constexpr int kPairs = 8;  // points per leaf are pairs at the three separations
constexpr std::array<double, 3> kSeparations{0.25, 0.5, 1.0};
const Vec3 kSun = glm::normalize(Vec3(0.3, -0.4, 1.0));

// Points on leaves with what is known of their light, and pairs of them at known separations.
struct LeafPoint {
  std::uint32_t leaf = 0;
  Vec3 centre{0}, position{0};
  double way_m = 0, transmittance = 1;
};
struct Sample {
  Forest forest;
  MaskLeaves leaves;
  std::vector<LeafPoint> points;  // [leaf][separation][pair][end]
};

double way_out_of_ball(const Vec3& p, const Vec3& centre, double radius) {
  const Vec3 o = p - centre;
  const double b = glm::dot(o, kSun), c = glm::dot(o, o) - radius * radius;
  return -b + std::sqrt(std::max(0.0, b * b - c));
}

const Sample& sample() {
  static const Sample made = [] {
    Sample s;
    s.forest = generated_crown({CrownKind::kSphere, 40000, 1, 5, 3});
    const Prototype& crown = s.forest.prototypes[0];
    s.leaves = mask_leaves(crown, "crown");
    const double extinction = 0.5 * leaf_area_m2(crown) / (4 * kPi / 3);
    RandomStream random(4, 0, RandomPurpose::kTestScene);
    for (std::uint32_t leaf = 0; leaf < 40000; leaf += 4) {
      const FoliageElement& e = crown.foliage[leaf];
      const Vec3 centre(e.centre_m), u(e.half_u_m), v(e.half_v_m);
      const double way = way_out_of_ball(centre, Vec3(0, 0, 1.5), 1);
      for (const double separation : kSeparations)
        for (int pair = 0; pair < kPairs / 4; ++pair) {
          double a = 0, b = 0, c = 2, d = 2;
          while (std::abs(c) > 1 || std::abs(d) > 1) {
            a = random.uniform(-1, 1), b = random.uniform(-1, 1);
            const double turn = random.uniform(0, 2 * kPi);
            c = a + 2 * separation * std::cos(turn), d = b + 2 * separation * std::sin(turn);
          }
          for (const Vec3& p : {centre + a * u + b * v, centre + c * u + d * v})
            s.points.push_back({leaf, centre, p, way, std::exp(-extinction * way)});
        }
    }
    return s;
  }();
  return made;
}

using Lit = std::function<bool(const LeafPoint&, double transmittance)>;

struct Figures {
  double mean_off = 0, worst_bin = 0, leaf_variance = 0;
  std::array<double, 3> correlation{};
};

// Means against T; correlation of (lit - T) over pairs, relative to T (1 - T).
Figures figures_of(const Lit& lit) {
  const auto& points = sample().points;
  std::vector<double> rest(points.size());
  std::array<double, 8> bin{}, bin_count{};
  Figures f;
  for (std::size_t i = 0; i < points.size(); ++i) {
    rest[i] = (lit(points[i], points[i].transmittance) ? 1.0 : 0.0) - points[i].transmittance;
    f.mean_off += rest[i] / static_cast<double>(points.size());
    const auto b = std::min<std::size_t>(7, static_cast<std::size_t>(points[i].way_m / 2 * 8));
    bin[b] += rest[i];
    bin_count[b] += 1;
  }
  for (int b = 0; b < 8; ++b) f.worst_bin = std::max(f.worst_bin, std::abs(bin[b] / bin_count[b]));
  constexpr std::size_t per_leaf = 3 * (kPairs / 4) * 2;
  std::array<double, 3> together{}, alone{};
  for (std::size_t i = 0; i < points.size(); i += 2) {
    const std::size_t k = i % per_leaf / (kPairs / 2);
    together[k] += rest[i] * rest[i + 1];
    alone[k] += points[i].transmittance * (1 - points[i].transmittance);
  }
  for (int k = 0; k < 3; ++k) f.correlation[k] = together[k] / alone[k];
  for (std::size_t i = 0; i < points.size(); i += per_leaf) {
    double mean = 0;
    for (std::size_t j = 0; j < per_leaf; ++j) mean += rest[i + j] / per_leaf;
    f.leaf_variance += mean * mean * per_leaf / static_cast<double>(points.size());
  }
  return f;
}

void print(const char* name, const Figures& f) {
  std::cout << name << ": mean " << f.mean_off << ", worst bin " << f.worst_bin << ", leaf variance "
            << f.leaf_variance << ", correlation " << f.correlation[0] << " " << f.correlation[1] << " "
            << f.correlation[2] << "\n";
}

const Figures& traced() {
  static const Figures f = [] {
    const RayScene scene(sample().forest, {.ground = false});
    const Figures found = figures_of([&](const LeafPoint& p, double) {
      const FoliageElement& e = sample().forest.prototypes[0].foliage[p.leaf];
      const bool front = glm::dot(element_normal(e), kSun) > 0;
      return !scene.occluded(p.position, kSun, 0, {HitKind::kFoliage, front, 0, p.leaf});
    });
    print("traced", found);
    return found;
  }();
  return f;
}

const ShadowTile& tile() {
  static const ShadowTile made = build_shadow_tile(sample().leaves, {});
  return made;
}

// The sheet's acceptance: means within .01 and .02 per bin of the way, correlations within .05 of traced
// ones, leaf variance within 10 %. Sampling noise of a mean of 1e4 independent leaves: .004.
bool accepted(const Figures& f) {
  bool good = std::abs(f.mean_off) <= 0.01 && f.worst_bin <= 0.02;
  for (int k = 0; k < 3; ++k) good = good && std::abs(f.correlation[k] - traced().correlation[k]) <= 0.05;
  return good && std::abs(f.leaf_variance / traced().leaf_variance - 1) <= 0.1;
}

TEST(ShadowTile, MeetsTheAcceptanceNumbers) {
  ASSERT_GE(sample().points.size(), 100000u);
  const TileView view = view_tile(tile(), kSun);
  const Figures world = figures_of(
      [&](const LeafPoint& p, double t) { return tile_lit(view, p.position, static_cast<float>(t)); });
  const Figures hashed = figures_of([&](const LeafPoint& p, double t) {
    return tile_lit(view, p.position, static_cast<float>(t), leaf_offset(p.leaf + 1));
  });
  print("tile, world", world);
  print("tile, per leaf", hashed);
  EXPECT_TRUE(accepted(world));
  EXPECT_TRUE(accepted(hashed));
}

TEST(ShadowTile, MeanIsTheTransmittanceAtAnyDensity) {
  const TileView view = view_tile(tile(), kSun);
  for (const double t : {0.95, 0.8, 0.5, 0.2, 0.05}) {
    double lit = 0;
    for (const LeafPoint& p : sample().points) lit += tile_lit(view, p.position, static_cast<float>(t));
    EXPECT_NEAR(lit / static_cast<double>(sample().points.size()), t, 0.01) << t;
    // Over the whole tile, exact to half a texel; the test of floats adds a rounding.
    double whole = 0;
    for (const std::uint16_t r : tile().rank) whole += (static_cast<double>(r) + 0.5) / 65536 > 1 - t;
    const double texels = static_cast<double>(tile().rank.size());
    EXPECT_NEAR(whole / texels, t, 0.5 / texels + 1e-9) << t;
  }
}

TEST(ShadowTile, DarkerForLessLightEverywhere) {
  const TileView view = view_tile(tile(), kSun);
  for (std::size_t i = 0; i < 2000; ++i) {
    bool before = false;
    for (int step = 0; step <= 20; ++step) {
      const bool lit = tile_lit(view, sample().points[i].position, static_cast<float>(step) / 20);
      EXPECT_GE(lit, before);
      before = lit;
    }
    EXPECT_TRUE(before);  // T = 1
  }
}

// A point deeper along the same ray of light with less light is never brighter (world coordinates).
TEST(ShadowTile, ConsistentAlongALightRay) {
  const TileView view = view_tile(tile(), kSun);
  for (std::size_t i = 0; i < 2000; ++i) {
    const Vec3 p = sample().points[i].position;
    if (tile_lit(view, p - 0.3 * kSun, 0.3f)) {
      EXPECT_TRUE(tile_lit(view, p, 0.31f));
    }
  }
}

TEST(ShadowTile, SoftEdgesKeepTheMean) {
  for (const double t : {0.01, 0.05, 0.2, 0.5, 0.8, 0.95}) {
    double sum = 0;
    const TileView view = view_tile(tile(), Vec3(0, 0, 1));
    const double texel = tile().width_m / tile().side;
    for (int row = 0; row < tile().side; ++row)
      for (int column = 0; column < tile().side; ++column)
        sum += static_cast<double>(
            tile_lit_share(view, Vec3(column * texel, row * texel, 0), static_cast<float>(t), 0.1f));
    EXPECT_NEAR(sum / static_cast<double>(tile().rank.size()), t, 0.002) << t;
  }
}

TEST(ShadowTile, RepeatsAndIsTheSameEveryTime) {
  const ShadowTile again = build_shadow_tile(sample().leaves, {});
  EXPECT_EQ(again.rank, tile().rank);
  const TileView view = view_tile(tile(), Vec3(0, 0, 1));
  const Basis basis = basis_around(Vec3(0, 0, 1));
  for (int i = 0; i < 100; ++i) {
    const Vec3 p(0.0137 * i + 1e-3, 0.0291 * i + 1e-3, 5);
    EXPECT_EQ(tile_rank(view, p),
              tile_rank(view, p + tile().width_m * basis.tangent - 7 * tile().width_m * basis.bitangent));
  }
  EXPECT_LE(tile().memory_bytes(), 1u << 20);
}

// The published form, one and four layers, must fail the acceptance: else the test would not tell them apart.
TEST(CubeMask, PublishedDistanceFormFails) {
  for (const int layers : {1, 4})
    for (const bool turn : {false, true}) {
      const CubeMask mask = build_cube_mask(sample().leaves, {MaskForm::kDistance, layers, 128, 7});
      const Figures f = figures_of([&](const LeafPoint& p, double) {
        return cube_lit(mask, {p.position - p.centre, kSun, p.way_m, {}, turn ? p.leaf + 1 : 0});
      });
      print((std::string("published, layers ") + std::to_string(layers) + (turn ? ", turned" : "")).c_str(),
            f);
      EXPECT_FALSE(accepted(f)) << layers << " " << turn;
    }
}

// Ranks mend the mean; with one layer shadows stay too large (leaves turned one by one, sphere of the mean
// distance). With four layers they come right as well, at 40 times the tile's cost.
TEST(CubeMask, RankFormMendsTheMean) {
  for (const int layers : {1, 4}) {
    const CubeMask mask = build_cube_mask(sample().leaves, {MaskForm::kRank, layers, 128, 7});
    const Figures f = figures_of([&](const LeafPoint& p, double) {
      return cube_lit(mask,
                      {p.position - p.centre, kSun, p.way_m,
                       layer_transmittances(mask, sample().leaves.extinction_per_m(), p.way_m), p.leaf + 1});
    });
    print((std::string("rank, turned, layers ") + std::to_string(layers)).c_str(), f);
    EXPECT_LE(std::abs(f.mean_off), 0.01);
    EXPECT_EQ(accepted(f), layers == 4);
  }
}

TEST(ShadowMasks, OtherLeafShapesAndBadInput) {
  Prototype crown;
  crown.materials = {"leaf"};
  RandomStream random(9, 0, RandomPurpose::kTestScene);
  for (int i = 0; i < 500; ++i) {
    FoliageElement e;
    e.centre_m = Vec3f(Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(1, 3)));
    e.half_u_m = {0.05f, 0, 0};
    e.half_v_m = {0, 0.05f, 0};
    e.shape = static_cast<ElementShape>(i % 4);
    e.area_m2 = 0.006f;
    crown.foliage.push_back(e);
  }
  const MaskLeaves leaves = mask_leaves(crown, "crown");
  EXPECT_LT(leaves.mean_cover_m2, leaves.mean_area_m2);  // shoots let light through
  const ShadowTile mixed = build_shadow_tile(leaves, {64, 8, 1});
  const std::set<std::uint16_t> ranks(mixed.rank.begin(), mixed.rank.end());
  EXPECT_EQ(ranks.size(), 64u * 64u);  // every rank once
  EXPECT_THROW(mask_leaves(Prototype{}, "crown"), Error);
  EXPECT_THROW(build_shadow_tile(leaves, {100, 8, 1}), Error);
  EXPECT_THROW(build_shadow_tile(leaves, {128, 0, 1}), Error);
  EXPECT_THROW(build_cube_mask(leaves, {MaskForm::kRank, 3, 128, 1}), Error);
  EXPECT_THROW(build_cube_mask(leaves, {MaskForm::kRank, 1, 4, 1}), Error);
}

}  // namespace
}  // namespace sunfleck
