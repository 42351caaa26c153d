// Explicit needles: their number, area and place, and what a spruce of them would weigh.
#include "sim/plant/needles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "sim/plant/grow_foliage.h"
#include "sim/plant/make_prototype.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

Species species_of(const std::string& file) {
  return load_species(test::source_dir() / "configs/species" / (file + ".toml"));
}

// A shoot of the template along x, `scale` times as large, its plane level.
FoliageElement level_shoot(const FoliageTemplate& foliage, double scale) {
  lsystem::TurtleState turtle;
  turtle.heading = {1, 0, 0};
  turtle.left = {0, 1, 0};
  turtle.up = {0, 0, 1};
  return shoot_element(turtle, scale * foliage.shoot_length_m, scale * foliage.shoot_radius_m,
                       scale * scale * foliage.shoot_area_m2());
}

std::vector<Needle> needles_of(const FoliageTemplate& foliage, double scale) {
  std::vector<Needle> needles;
  expand_needles(level_shoot(foliage, scale), foliage, 3, 7, needles);
  return needles;
}

const char* const kConifers[] = {"picea_abies", "abies_alba", "pinus_sylvestris", "larix_decidua"};

// One-sided area of a round needle: half of pi * width * length.
TEST(Needles, KeepTheShootsAreaAndNumber) {
  for (const char* file : kConifers) {
    const FoliageTemplate foliage = species_of(file).foliage;
    for (const double scale : {1.0, 3.0}) {
      const auto needles = needles_of(foliage, scale);
      EXPECT_EQ(needles.size(), needle_count(foliage));
      EXPECT_NEAR(static_cast<double>(needles.size()), foliage.needles_per_m * foliage.shoot_length_m, 0.5);
      double area_m2 = 0;
      for (const Needle& n : needles) {
        const double length = glm::distance(Vec3(n.base_m), Vec3(n.tip_m));
        EXPECT_NEAR(length, scale * foliage.needle_length_m, 1e-5 * scale) << file;
        area_m2 += kPi * length * n.radius_m;
      }
      EXPECT_NEAR(area_m2, scale * scale * foliage.shoot_area_m2(), 1e-4 * area_m2) << file;
      EXPECT_NEAR(2 * needles[0].radius_m, scale * foliage.needle_width_m,
                  1e-2 * scale * foliage.needle_width_m);
    }
  }
}

TEST(Needles, LieInTheShootsCylinder) {
  for (const char* file : kConifers) {
    const FoliageTemplate foliage = species_of(file).foliage;
    for (const Needle& n : needles_of(foliage, 1))
      for (const Vec3f& p : {n.base_m, n.tip_m}) {
        EXPECT_GE(p.x, -1e-6) << file;
        EXPECT_LE(p.x, foliage.shoot_length_m + 1e-6) << file;
        EXPECT_LE(std::hypot(p.y, p.z), foliage.shoot_radius_m + 1e-6) << file;
      }
  }
}

double elevation_deg(const Needle& n) {
  const Vec3 way = Vec3(n.tip_m) - Vec3(n.base_m);
  return degrees_from_radians(std::abs(std::asin(way.z / glm::length(way))));
}

// Fir combs its needles into the spray's plane; round shoots are as high as wide: mean |elevation| of needles
// leaning 50 degrees from the axis and spread evenly round it is about 30 degrees.
TEST(Needles, FirIsCombedFlatAndSpruceIsRound) {
  const auto mean_of = [&](const char* file) {
    double sum = 0;
    const auto needles = needles_of(species_of(file).foliage, 1);
    for (const Needle& n : needles) sum += elevation_deg(n);
    return sum / static_cast<double>(needles.size());
  };
  EXPECT_LT(mean_of("abies_alba"), 12);
  EXPECT_GT(mean_of("picea_abies"), 24);
  EXPECT_LT(mean_of("picea_abies"), 36);
}

std::size_t different_heights(const char* file) {
  std::set<float> along;
  for (const Needle& n : needles_of(species_of(file).foliage, 1)) along.insert(n.base_m.x);
  return along.size();
}

// Needles of one fascicle begin at the same height along the shoot: 140 single ones in spruce, pairs in pine,
// tufts of 35 in larch (312 needles: nine tufts, the last one short).
TEST(Needles, StandInFascicles) {
  EXPECT_EQ(different_heights("picea_abies"), 140u);
  EXPECT_EQ(different_heights("pinus_sylvestris"), 72u);
  EXPECT_EQ(different_heights("larix_decidua"), 9u);
}

TEST(Needles, AreTheSameTwiceAndOtherForAnotherShoot) {
  const FoliageTemplate foliage = species_of("picea_abies").foliage;
  std::vector<Needle> a, b, c;
  expand_needles(level_shoot(foliage, 1), foliage, 3, 7, a);
  expand_needles(level_shoot(foliage, 1), foliage, 3, 7, b);
  expand_needles(level_shoot(foliage, 1), foliage, 3, 8, c);
  const auto same = [](const Needle& x, const Needle& y) {
    return x.base_m == y.base_m && x.tip_m == y.tip_m;
  };
  EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), same));
  EXPECT_FALSE(std::equal(a.begin(), a.end(), c.begin(), same));
}

// 2 to 4 million needles are counted on spruces of this size; as shoots they must fit in 60 MB, and the
// tree's leaf area is that of its needles.
TEST(Needles, ASpruceOf30CmHasMillionsAndFits) {
  const Species spruce = species_of("picea_abies");
  const Prototype tree = grow_prototype(spruce, expected_size(spruce, 30), 1, 1);
  const double bytes = static_cast<double>(tree.foliage.size() * sizeof(FoliageElement) +
                                           tree.wood.size() * sizeof(WoodSegment));
  EXPECT_LT(bytes, 60e6);
  std::vector<Needle> needles;
  double count = 0, area_m2 = 0;
  for (std::size_t i = 0; i < tree.foliage.size(); ++i) {
    needles.clear();
    expand_needles(tree.foliage[i], spruce.foliage, 1, i, needles);
    count += static_cast<double>(needles.size());
    for (const Needle& n : needles)
      area_m2 += kPi * glm::distance(Vec3(n.base_m), Vec3(n.tip_m)) * n.radius_m;
  }
  EXPECT_GT(count, 2e6);
  EXPECT_LT(count, 4e6);
  EXPECT_NEAR(area_m2, leaf_area_m2(tree), 1e-3 * area_m2);
  RecordProperty("needles", std::to_string(count));
  RecordProperty("megabytes", std::to_string(bytes / 1e6));
}

}  // namespace
}  // namespace sunfleck
