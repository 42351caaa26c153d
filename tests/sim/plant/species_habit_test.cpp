// What makes a species recognisable: how its leaves and branches are set and how they hang or rise. Counted
// in the drawings of the grammars at their own sizes (30 cm DBH), or in the grown tree where nothing is lost.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "sim/lsystem/lsystem.h"
#include "sim/plant/make_prototype.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

lsystem::Drawing drawn(const std::string& file) {
  const auto grammar = lsystem::Grammar::load(test::source_dir() / "configs/grammars" / (file + ".lsys"));
  return grammar.interpret(grammar.derive({}), lsystem::StartFrame::kTree);
}

Prototype grown(const std::string& file, double dbh_cm = 30) {
  const Species species = load_species(test::source_dir() / "configs/species" / (file + ".toml"));
  return grow_prototype(species, expected_size(species, dbh_cm), 1, 1);
}

Vec3 axis_of(const lsystem::Segment& segment) { return glm::normalize(segment.to_m - segment.from_m); }

// Angles (degrees, 0 to 180) round the twig between leaves that follow each other on it.
std::vector<double> divergences_deg(const lsystem::Drawing& drawing) {
  std::vector<double> angles;
  for (std::size_t i = 1; i < drawing.organs.size(); ++i) {
    const auto &a = drawing.organs[i - 1], &b = drawing.organs[i];
    if (a.segment < 0 || a.segment != b.segment) continue;
    const Vec3 axis = axis_of(drawing.segments[static_cast<std::size_t>(a.segment)]);
    const auto across = [&](const Vec3& heading) {
      return glm::normalize(heading - axis * glm::dot(axis, heading));
    };
    const double cosine = glm::dot(across(a.turtle.heading), across(b.turtle.heading));
    angles.push_back(degrees_from_radians(std::acos(std::clamp(cosine, -1.0, 1.0))));
  }
  return angles;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

// Two-ranked in beech (the headings are turned a little out of the plane), 2/5 = 144 degrees in oak and birch
// (birch: 25 degrees of chance either way).
TEST(SpeciesHabit, LeavesFollowThePhyllotaxis) {
  const auto beech = divergences_deg(drawn("fagus_sylvatica")), oak = divergences_deg(drawn("quercus_robur")),
             birch = divergences_deg(drawn("betula_pendula"));
  ASSERT_GT(std::min({beech.size(), oak.size(), birch.size()}), 1000u);
  EXPECT_GT(mean(beech), 150);
  EXPECT_NEAR(median(oak), 144, 1);
  EXPECT_NEAR(mean(birch), 144, 8);
}

double mean_inclination_deg(const Prototype& tree) {
  std::vector<double> angles;
  for (const FoliageElement& e : tree.foliage)
    angles.push_back(degrees_from_radians(std::acos(std::min(1.0, std::abs(element_normal(e).z)))));
  return mean(angles);
}

// Stated means: beech 20-30, oak about 30-40, birch about 45-50 degrees; a few degrees for the tree drawn.
TEST(SpeciesHabit, LeavesLieAsStated) {
  EXPECT_NEAR(mean_inclination_deg(grown("fagus_sylvatica")), 25, 6);
  EXPECT_NEAR(mean_inclination_deg(grown("quercus_robur")), 36, 6);
  EXPECT_NEAR(mean_inclination_deg(grown("betula_pendula")), 47.5, 5);
}

// Branches that stand together on the stem (segments that begin within a centimetre of each other and leave
// it at more than 30 degrees), counted from node to node.
std::vector<int> whorls(const lsystem::Drawing& drawing) {
  std::map<std::int64_t, int> at_height;
  for (const lsystem::Segment& s : drawing.segments)
    if (std::hypot(s.from_m.x, s.from_m.y) < 0.02 && axis_of(s).z < 0.85)
      ++at_height[std::lround(100 * s.from_m.z)];
  std::vector<int> counts;
  for (const auto& [height, count] : at_height) counts.push_back(count);
  return counts;
}

// 4-6 in spruce and 3 weaker ones between; 3-5 and 2 in fir; pine 3-6, some of them lost, and no others.
TEST(SpeciesHabit, ConifersBranchInWhorls) {
  const auto share = [](const std::vector<int>& counts, int least, int most) {
    return static_cast<double>(
               std::count_if(counts.begin(), counts.end(), [&](int c) { return c >= least && c <= most; })) /
           static_cast<double>(counts.size());
  };
  const auto spruce = whorls(drawn("picea_abies")), fir = whorls(drawn("abies_alba"));
  EXPECT_GT(spruce.size(), 40u);
  EXPECT_NEAR(share(spruce, 4, 6), 0.5, 0.12);
  EXPECT_NEAR(share(spruce, 3, 3), 0.5, 0.12);
  EXPECT_GT(share(fir, 2, 5), 0.95);
  EXPECT_GT(fir.size(), 40u);
}

// The stem of a conifer goes straight up to the top: it ends within 3 % of the height over its foot.
TEST(SpeciesHabit, ConiferStemsAreUpright) {
  for (const char* file : {"picea_abies", "abies_alba", "larix_decidua"}) {
    const lsystem::Drawing drawing = drawn(file);
    const auto top = std::max_element(drawing.segments.begin(), drawing.segments.end(),
                                      [](const auto& a, const auto& b) { return a.to_m.z < b.to_m.z; });
    EXPECT_LT(std::hypot(top->to_m.x, top->to_m.y), 0.03 * top->to_m.z) << file;
  }
}

double mean_shoot_elevation_deg(const Prototype& tree) {
  std::vector<double> angles;
  for (const FoliageElement& e : tree.foliage)
    angles.push_back(
        degrees_from_radians(std::asin(std::min(1.0f, std::abs(e.half_u_m.z) / glm::length(e.half_u_m)))));
  return mean(angles);
}

// Fir's sprays lie flat; spruce's twigs hang from its boughs, pine's tufts point everywhere.
TEST(SpeciesHabit, FirSpraysAreLevel) {
  const double fir = mean_shoot_elevation_deg(grown("abies_alba"));
  EXPECT_LT(fir, 16);
  EXPECT_GT(mean_shoot_elevation_deg(grown("picea_abies")), fir + 5);
  EXPECT_GT(mean_shoot_elevation_deg(grown("pinus_sylvestris")), fir + 8);
}

// Share of the length of thin wood (below `radius_m`) that goes down steeper than 30 degrees.
double hanging_share(const Prototype& tree, double radius_m) {
  double all = 0, down = 0;
  for (const WoodSegment& s : tree.wood) {
    if (s.radius_from_m > radius_m) continue;
    const Vec3 way = Vec3(s.to_m) - Vec3(s.from_m);
    all += glm::length(way);
    if (way.z < -0.5 * glm::length(way)) down += glm::length(way);
  }
  return down / all;
}

TEST(SpeciesHabit, BirchTwigsHangOthersDoNot) {
  EXPECT_GT(hanging_share(grown("betula_pendula"), 0.003), 0.5);
  EXPECT_LT(hanging_share(grown("fagus_sylvatica"), 0.003), 0.1);
  EXPECT_LT(hanging_share(grown("quercus_robur"), 0.003), 0.3);
}

// Oak's boughs are crooked: along a limb, direction changes by this much from one year's growth to the next
// (wood thicker than 1 cm that has one child of nearly its own girth).
TEST(SpeciesHabit, OakBoughsAreCrooked) {
  const auto turn_deg = [](const Prototype& tree) {
    std::vector<double> turns;
    for (std::size_t i = 1; i < tree.wood.size(); ++i) {
      const WoodSegment &a = tree.wood[i - 1], &b = tree.wood[i];
      if (a.to_m != b.from_m || b.radius_from_m < 0.01f || b.radius_from_m < 0.7f * a.radius_from_m ||
          b.from_m.z < 4)
        continue;
      const Vec3 u = glm::normalize(Vec3(a.to_m) - Vec3(a.from_m)),
                 v = glm::normalize(Vec3(b.to_m) - Vec3(b.from_m));
      turns.push_back(degrees_from_radians(std::acos(std::clamp(glm::dot(u, v), -1.0, 1.0))));
    }
    return mean(turns);
  };
  const double oak = turn_deg(grown("quercus_robur", 45)), beech = turn_deg(grown("fagus_sylvatica", 45));
  EXPECT_GT(oak, 15);
  EXPECT_GT(oak, 1.7 * beech);
}

// Larch has a sparse crown: less leaf area than spruce per volume of its crown (ball of its length and
// width).
TEST(SpeciesHabit, LarchIsSparse) {
  const auto density = [](const char* file) {
    const TreeMeasures m = measure(grown(file));
    return m.leaf_area_m2 / ((m.height_m - m.crown_base_m) * m.crown_radius_m * m.crown_radius_m);
  };
  EXPECT_LT(density("larix_decidua"), 0.95 * density("picea_abies"));
}

}  // namespace
}  // namespace sunfleck
