// Trees grown by the shipped grammars meet the allometry of their species, size by size, and look like it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "sim/plant/make_prototype.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

Species shipped_species(const std::string& file) {
  return load_species(test::source_dir() / "configs/species" / (file + ".toml"));
}

struct Case {
  const char* species;
  double dbh_cm;
};
void PrintTo(const Case& one, std::ostream* out) { *out << one.species << " " << one.dbh_cm << " cm"; }

class GrownSize : public testing::TestWithParam<Case> {};

// DBH and leaf area are scaled to, so only rounding is left; the outline is fitted in three rounds, to the
// part of a leaf that does not scale with it.
TEST_P(GrownSize, MeetsTheAllometry) {
  const Species species = shipped_species(GetParam().species);
  const TreeSize size = expected_size(species, GetParam().dbh_cm);
  for (const std::uint64_t seed : {1, 2}) {
    const Prototype tree = grow_prototype(species, size, seed, 1);
    const TreeMeasures m = measure(tree);
    EXPECT_NEAR(m.dbh_m, size.dbh_m, 1e-4 * size.dbh_m);
    EXPECT_NEAR(m.leaf_area_m2, size.leaf_area_m2, 1e-4 * size.leaf_area_m2);
    EXPECT_NEAR(m.height_m, size.height_m, 0.02 * size.height_m);
    EXPECT_NEAR(m.crown_base_m, size.crown_base_m, 0.02 * size.crown_base_m);
    EXPECT_NEAR(m.crown_radius_m, size.crown_radius_m, 0.02 * size.crown_radius_m);
  }
}

// Elements keep close to the size of the species' leaf or shoot: between half and twice its area.
TEST_P(GrownSize, ElementsHaveTheSizeOfTheTemplate) {
  const Species species = shipped_species(GetParam().species);
  const Prototype tree = grow_prototype(species, expected_size(species, GetParam().dbh_cm), 1, 1);
  const FoliageTemplate& leaf = species.foliage;
  const double usual_m2 =
      leaf.kind == FoliageKind::kLeaf ? 0.5 * leaf.leaf_length_m * leaf.leaf_width_m : leaf.shoot_area_m2();
  EXPECT_GT(tree.foliage.front().area_m2, 0.5 * usual_m2);
  EXPECT_LT(tree.foliage.front().area_m2, 2.0 * usual_m2);
  EXPECT_EQ(tree.foliage.front().shape == ElementShape::kShoot, leaf.kind == FoliageKind::kShoot);
}

// Wood hangs together: every segment but the lowest begins where another one ends.
TEST_P(GrownSize, WoodIsConnected) {
  const Species species = shipped_species(GetParam().species);
  const Prototype tree = grow_prototype(species, expected_size(species, GetParam().dbh_cm), 1, 1);
  const auto before = [](const Vec3f& a, const Vec3f& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  };
  std::vector<Vec3f> ends{Vec3f(0)};
  for (const WoodSegment& s : tree.wood) ends.push_back(s.to_m);
  std::sort(ends.begin(), ends.end(), before);
  for (const WoodSegment& s : tree.wood)
    EXPECT_TRUE(std::binary_search(ends.begin(), ends.end(), s.from_m, before))
        << s.from_m.x << " " << s.from_m.y << " " << s.from_m.z;
}

INSTANTIATE_TEST_SUITE_P(
    SpeciesAndSize, GrownSize,
    testing::Values(Case{"fagus_sylvatica", 10}, Case{"fagus_sylvatica", 20}, Case{"fagus_sylvatica", 30},
                    Case{"fagus_sylvatica", 45}, Case{"pinus_sylvestris", 10}, Case{"pinus_sylvestris", 20},
                    Case{"pinus_sylvestris", 30}, Case{"pinus_sylvestris", 45}, Case{"picea_abies", 10},
                    Case{"picea_abies", 20}, Case{"picea_abies", 30}, Case{"picea_abies", 45}),
    [](const auto& one) {
      return std::string(one.param.species) + "_" + std::to_string(static_cast<int>(one.param.dbh_cm));
    });

// Inventories hold saplings, giants, low and narrow crowns: all of them grow, none into the ground.
TEST(GrownOddSizes, AreMetToo) {
  for (const char* file : {"fagus_sylvatica", "pinus_sylvestris", "picea_abies"}) {
    const Species species = shipped_species(file);
    for (const double dbh_cm : {2.0, 5.0, 100.0})
      for (const double crown : {0.5, 1.0, 2.0}) {
        TreeSize size = expected_size(species, dbh_cm);
        size.crown_radius_m *= crown;
        size.crown_base_m *= crown < 1 ? 1.3 : 0.3;
        const TreeMeasures m = measure(grow_prototype(species, size, 1, 0.2));
        SCOPED_TRACE(std::string(file) + " " + std::to_string(dbh_cm) + " crown " + std::to_string(crown));
        EXPECT_NEAR(m.height_m, size.height_m, 0.05 * size.height_m);
        EXPECT_NEAR(m.crown_base_m, size.crown_base_m, 0.05 * size.crown_base_m);
        EXPECT_NEAR(m.crown_radius_m, size.crown_radius_m, 0.05 * size.crown_radius_m);
        EXPECT_NEAR(m.leaf_area_m2, size.leaf_area_m2, 1e-4 * size.leaf_area_m2);
      }
  }
}

// Largest distance of foliage from the stem between two shares of the crown's depth, counted from its base.
double reach_m(const Prototype& tree, double from, double to) {
  const TreeMeasures m = measure(tree);
  double reach = 0;
  for (const FoliageElement& e : tree.foliage) {
    const double share = (e.centre_m.z - m.crown_base_m) / (m.height_m - m.crown_base_m);
    if (share >= from && share < to)
      reach = std::max(reach, std::hypot(double{e.centre_m.x}, double{e.centre_m.y}));
  }
  return reach;
}

Prototype grown(const std::string& species_file) {
  const Species species = shipped_species(species_file);
  return grow_prototype(species, expected_size(species, 30), 1, 1);
}

TEST(GrownShape, SpruceIsACone) {
  const Prototype tree = grown("picea_abies");
  for (double share = 0.2; share < 0.85; share += 0.2)
    EXPECT_LT(reach_m(tree, share, share + 0.2), reach_m(tree, share - 0.2, share)) << share;
  EXPECT_LT(reach_m(tree, 0.8, 1), 0.4 * reach_m(tree, 0, 0.2));
}

TEST(GrownShape, PineIsRoundAtTheTop) {
  const Prototype tree = grown("pinus_sylvestris");
  EXPECT_GT(reach_m(tree, 0.7, 0.9), 0.45 * reach_m(tree, 0, 1));
}

TEST(GrownShape, BeechIsADome) {
  const Prototype tree = grown("fagus_sylvatica");
  EXPECT_GT(reach_m(tree, 0.4, 0.6), 0.8 * reach_m(tree, 0, 1));
  EXPECT_GT(reach_m(tree, 0.75, 0.9), 0.4 * reach_m(tree, 0, 1));
  EXPECT_LT(reach_m(tree, 0, 0.08), 0.75 * reach_m(tree, 0, 1));
}

// Planophile leaves: mean inclination 20-30 degrees is stated for the species; front faces look up.
TEST(GrownShape, BeechLeavesLieFlat) {
  const Prototype tree = grown("fagus_sylvatica");
  double sum_deg = 0;
  std::size_t upward = 0;
  for (const FoliageElement& e : tree.foliage) {
    const Vec3 normal = element_normal(e);
    sum_deg += degrees_from_radians(std::acos(std::min(1.0, std::abs(normal.z))));
    upward += normal.z > 0 ? 1 : 0;
  }
  const auto count = static_cast<double>(tree.foliage.size());
  EXPECT_GT(sum_deg / count, 18);
  EXPECT_LT(sum_deg / count, 32);
  EXPECT_GT(static_cast<double>(upward), 0.9 * count);
}

}  // namespace
}  // namespace sunfleck
