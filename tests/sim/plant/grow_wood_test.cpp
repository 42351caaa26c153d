// How much wood the grown trees have: against leaf area, and at coarser detail.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "sim/lsystem/lsystem.h"
#include "sim/plant/grow_wood.h"
#include "sim/plant/make_prototype.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

Species shipped_species(const std::string& file) {
  return load_species(test::source_dir() / "configs/species" / (file + ".toml"));
}

double side_area_m2(const WoodSegment& s) {
  const double along = glm::distance(Vec3(s.from_m), Vec3(s.to_m)), taper = s.radius_to_m - s.radius_from_m;
  return kPi * (double{s.radius_from_m} + double{s.radius_to_m}) * std::hypot(along, taper);
}

// Half the side area of all wood, what a one-sided leaf area compares with.
double half_wood_area_m2(const Prototype& tree) {
  double sum = 0;
  for (const WoodSegment& s : tree.wood) sum += 0.5 * side_area_m2(s);
  return sum;
}

// Woody to plant area ratios of measured stands are about 0.1 to 0.3; single trees scatter round that.
TEST(GrownWood, IsAShareOfTheLeafArea) {
  for (const char* file : {"fagus_sylvatica", "picea_abies", "pinus_sylvestris"})
    for (const double dbh_cm : {10.0, 20.0, 30.0, 45.0}) {
      const Species species = shipped_species(file);
      const Prototype tree = grow_prototype(species, expected_size(species, dbh_cm), 1, 1);
      const double share = half_wood_area_m2(tree) / leaf_area_m2(tree);
      SCOPED_TRACE(std::string(file) + " " + std::to_string(dbh_cm) + " cm: " + std::to_string(share));
      EXPECT_GT(share, 0.05);
      EXPECT_LT(share, 0.35);
    }
}

// Ends of wood at which no other segment begins.
std::size_t tips(const Prototype& tree) {
  const auto before = [](const Vec3f& a, const Vec3f& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  };
  std::vector<Vec3f> begins;
  for (const WoodSegment& s : tree.wood) begins.push_back(s.from_m);
  std::sort(begins.begin(), begins.end(), before);
  const auto is_tip = [&](const WoodSegment& s) {
    return !std::binary_search(begins.begin(), begins.end(), s.to_m, before);
  };
  return static_cast<std::size_t>(std::count_if(tree.wood.begin(), tree.wood.end(), is_tip));
}

// Every tip carries an element of its own, so there are no more tips than elements; unthinned wood has
// thousands of tips, more than ten times what a detail of 0.06 leaves of pine shoots.
TEST(GrownWood, ThinnedTreesHaveNoBareTwigs) {
  for (const char* file : {"fagus_sylvatica", "picea_abies", "pinus_sylvestris"}) {
    const Species species = shipped_species(file);
    const TreeSize size = expected_size(species, 30);
    std::size_t more = std::numeric_limits<std::size_t>::max();
    for (const double detail : {1.0, 0.15, 0.06}) {
      const Prototype tree = grow_prototype(species, size, 1, detail);
      SCOPED_TRACE(std::string(file) + " at detail " + std::to_string(detail) + ": " +
                   std::to_string(tree.wood.size()) + " segments");
      EXPECT_LE(tips(tree), tree.foliage.size());
      EXPECT_LT(tree.wood.size(), more);
      more = tree.wood.size();
      const TreeMeasures m = measure(tree);
      EXPECT_NEAR(m.dbh_m, size.dbh_m, 1e-4 * size.dbh_m);
      EXPECT_NEAR(m.height_m, size.height_m, 0.02 * size.height_m);
      EXPECT_NEAR(m.crown_base_m, size.crown_base_m, 0.02 * size.crown_base_m);
      EXPECT_NEAR(m.crown_radius_m, size.crown_radius_m, 0.02 * size.crown_radius_m);
      EXPECT_NEAR(m.leaf_area_m2, size.leaf_area_m2, 1e-4 * size.leaf_area_m2);
    }
  }
}

// A stem of 30 cm has 707 cm2: with 80 m2 of leaves the rule's half is less than 5 cm2 per m2, with 18.7 m2
// (birch) not.
TEST(PipedWood, FewLeavesHaveLittleLivingWood) {
  EXPECT_DOUBLE_EQ(living_share(0.3, 80), kLivingShare);
  EXPECT_NEAR(living_share(0.3, 18.7), 5e-4 * 18.7 / (0.25 * kPi * 0.09), 1e-12);
  EXPECT_LT(living_share(0.6, 41), 0.1);
}

lsystem::Drawing forked() {
  const auto grammar = lsystem::Grammar::parse(
      "symbols: Leaf\norgans: Leaf\naxiom: F[+F Leaf][-F Leaf]F[+F Leaf]F Leaf\n", "forked");
  return grammar.interpret(grammar.axiom(), lsystem::StartFrame::kTree);
}

// Segments: foot 0, twigs 1 and 2 on it, leader 3 with twig 4 and tip 5; organs on 1, 2, 4, 5.
TEST(CarryingSegments, ArePathsFromTheFootToTheOrgans) {
  const lsystem::Drawing drawing = forked();
  const auto carrying = [&](std::vector<std::size_t> organs) { return carrying_segments(drawing, organs); };
  EXPECT_EQ(carrying({1}), (std::vector<bool>{true, false, true, false, false, false}));
  EXPECT_EQ(carrying({0, 2}), (std::vector<bool>{true, true, false, true, true, false}));
  EXPECT_EQ(carrying({0, 1, 2, 3}), std::vector<bool>(6, true));
}

// Four pipes at the foot, two in the leader, one in each tip. With half of the stem living, r^2 of a segment
// with the share f of the pipes is 4 f (1/2 + f/2): 4, 1.5 and 0.625.
TEST(PipedWood, DisusedPipesThickenTheStem) {
  const auto wood = piped_wood(forked(), 2, 0.5);
  const double squares[] = {4, 0.625, 0.625, 1.5, 0.625, 0.625};
  ASSERT_EQ(wood.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(wood[i].radius_from_m, std::sqrt(squares[i]), 1e-6) << i;
  EXPECT_NEAR(wood[0].radius_to_m, std::sqrt(1.5), 1e-6);  // narrows to its thickest child
  const auto all_alive = piped_wood(forked(), 2, 1);
  EXPECT_NEAR(all_alive[3].radius_from_m, std::sqrt(2.0), 1e-6);
}

}  // namespace
}  // namespace sunfleck
