// Crown prototypes: exact leaf area, right elements and stem, measures of the shape, refusal of bad input.
#include <cmath>
#include <fstream>
#include <sstream>

#include "sim/plant/crown_shape.h"
#include "tests/sim/plant/crown_fixture.h"
#include "tests/sim/plant/refusal.h"

namespace sunfleck {
namespace {

TEST(CrownPrototype, LeafAreaIsExactForAnyNumberOfElements) {
  for (const Species& species : {test::broadleaf(), test::conifer()})
    for (const int elements : {1, 2, 7, 1000, 100000}) {
      const Prototype tree = crown_prototype(species, test::crooked_crown(), {61.7, elements, 3});
      EXPECT_EQ(tree.foliage.size(), static_cast<std::size_t>(elements));
      EXPECT_NEAR(leaf_area_m2(tree) / 61.7, 1.0, 1e-6) << elements;  // asked for: 1e-5
      EXPECT_NO_THROW(validate(tree, "tree"));
    }
}

TEST(CrownPrototype, LeavesAreRectanglesOfTheSpecies) {
  const Prototype tree = crown_prototype(test::broadleaf(), test::crooked_crown(), {50, 2000, 5});
  for (const FoliageElement& e : tree.foliage) {
    const Vec3 u(e.half_u_m), v(e.half_v_m);
    EXPECT_EQ(e.shape, ElementShape::kParallelogram);
    EXPECT_NEAR(glm::length(u) / glm::length(v), 1.5, 1e-5);  // 9 cm : 6 cm
    EXPECT_NEAR(glm::dot(u, v), 0, 1e-8);
    EXPECT_GE(element_normal(e).z, -1e-6);  // front is the upper side
    EXPECT_NEAR(e.area_m2, 0.025, 2e-6);
  }
}

// Template: 200 needles of pi/2 * 0.02 * 0.001 m2 in a cylinder of pi * 0.02^2 * 0.1 m3: 50 m2 per m3.
TEST(CrownPrototype, ShootsKeepTheNeedleDensityOfTheSpecies) {
  const Prototype tree = crown_prototype(test::conifer(), test::crooked_crown(), {80, 500, 5});
  for (const FoliageElement& e : tree.foliage) {
    const double length = 2 * glm::length(Vec3(e.half_u_m)), radius = glm::length(Vec3(e.half_v_m));
    EXPECT_EQ(e.shape, ElementShape::kShoot);
    EXPECT_NEAR(length / radius, 5.0, 1e-4);
    EXPECT_NEAR(glm::dot(Vec3(e.half_u_m), Vec3(e.half_v_m)), 0, 1e-6);
    EXPECT_NEAR(e.area_m2 / (kPi * radius * radius * length), 50.0, 1e-2);
  }
}

TEST(CrownPrototype, ElementsStandInTheCrownOutsideTheStem) {
  const CrownShape crown = test::crooked_crown();
  for (const Species& species : {test::broadleaf(), test::conifer()}) {
    const Prototype tree = crown_prototype(species, crown, {60, 20000, 1});
    for (const FoliageElement& e : tree.foliage) {
      ASSERT_TRUE(inside_crown(crown, Vec3(e.centre_m), 1e-5));
      // The cone: radius 0.14 m at 1.3 m falling to 0 at 18 m.
      ASSERT_GE(std::hypot(e.centre_m.x, e.centre_m.y), 0.14 * (18 - e.centre_m.z) / 16.7 - 1e-6);
    }
  }
}

// Largest radii are met by samples only nearly: of n points in a sector, about n (2 eps)^1.5 lie within eps
// of the rim; with 2,500 points per quadrant 3 % holds with a chance of failure below 1e-9. Of the lower half
// (2,500 points) about 1.5 delta^2 lie within delta of the base's tip: 5 % of 3 m fails with below 1e-3.
TEST(CrownPrototype, MeasuresAgreeWithTheShape) {
  CrownShape crown = test::crooked_crown();
  crown.radius_nesw_m = {3, 3, 3, 3};
  const TreeMeasures m = measure(crown_prototype(test::broadleaf(), crown, {60, 10000, 2}));
  EXPECT_NEAR(m.dbh_m, 0.28, 1e-6);
  EXPECT_NEAR(m.height_m, 18, 0.05);  // a leaf of 4 cm may overhang the top
  EXPECT_NEAR(m.crown_radius_m, 3, 0.09);
  EXPECT_NEAR(m.crown_base_m, 6, 0.15);
  EXPECT_GE(m.crown_base_m, 6 - 1e-5);
  EXPECT_NEAR(m.leaf_area_m2, 60, 1e-4);
}

TEST(CrownPrototype, SameSeedSameTreeOtherSeedOtherTree) {
  const auto tree = [](std::uint64_t seed) {
    return crown_prototype(test::broadleaf(), test::crooked_crown(), {60, 50, seed});
  };
  const Prototype a = tree(1), b = tree(1), c = tree(2);
  for (std::size_t i = 0; i < a.foliage.size(); ++i) {
    EXPECT_EQ(a.foliage[i].centre_m, b.foliage[i].centre_m);
    EXPECT_NE(a.foliage[i].centre_m, c.foliage[i].centre_m);
  }
}

TEST(CrownPrototype, ShrubsFlatCrownsAndBareGround) {
  CrownShape shrub;
  shrub.height_m = 0.8;
  shrub.base_m = shrub.widest_m = 0;
  shrub.radius_nesw_m = {0.4, 0.4, 0.4, 0.4};
  shrub.dbh_m = 0.02;
  for (const Species& species : {test::broadleaf(), test::conifer()}) {
    const Prototype tree = crown_prototype(species, shrub, {0.5, 400, 1});
    EXPECT_GE(prototype_bounds(tree).lo.z, -1e-6);
    EXPECT_DOUBLE_EQ(measure(tree).dbh_m, 0.02);  // stated: the stem ends below 1.3 m
    EXPECT_NO_THROW(validate(tree, "shrub"));
  }
  CrownShape flat_top = test::crooked_crown();
  flat_top.widest_m = flat_top.height_m;
  EXPECT_NEAR(leaf_area_m2(crown_prototype(test::broadleaf(), flat_top, {10, 99, 1})), 10, 1e-5);
}

TEST(CrownPrototype, BadCrownsAndFillsAreRefused) {
  struct Case {
    std::function<void(CrownShape&, CrownFill&)> spoil;
    const char *where, *problem, *remedy;
  };
  const double nan = std::nan("");
  const Case cases[] = {
      {[](CrownShape& c, CrownFill&) { c.radius_nesw_m[1] = 0; }, "crown radius E", "no radius", "above 0"},
      {[=](CrownShape& c, CrownFill&) { c.radius_nesw_m[3] = nan; }, "crown radius W", "no radius", "metres"},
      {[](CrownShape& c, CrownFill&) { c.height_m = -2; }, "height", "no height", "metres"},
      {[](CrownShape& c, CrownFill&) { c.base_m = 18; }, "crown base", "between", "below the tree's height"},
      {[](CrownShape& c, CrownFill&) { c.base_m = -1; }, "crown base", "between", "from 0"},
      {[](CrownShape& c, CrownFill&) { c.widest_m = 5; }, "largest radius", "not within", "to the top"},
      {[](CrownShape& c, CrownFill&) { c.widest_m = 19; }, "largest radius", "not within", "to the top"},
      {[=](CrownShape& c, CrownFill&) { c.widest_m = nan; }, "largest radius", "not within", "to the top"},
      {[](CrownShape& c, CrownFill&) { c.dbh_m = -0.1; }, "dbh", "no stem diameter", "metres"},
      {[](CrownShape&, CrownFill& f) { f.leaf_area_m2 = 0; }, "leaf area", "no leaf area", "above 0"},
      {[=](CrownShape&, CrownFill& f) { f.leaf_area_m2 = nan; }, "leaf area", "no leaf area", "above 0"},
      {[](CrownShape&, CrownFill& f) { f.elements = 0; }, "elements", "0 foliage elements", "from 1"},
  };
  for (const Case& each : cases) {
    CrownShape crown = test::crooked_crown();
    CrownFill fill;
    each.spoil(crown, fill);
    test::expect_refused([&] { crown_prototype(test::broadleaf(), crown, fill); }, ErrorKind::kInvalidInput,
                         each.where, each.problem, each.remedy);
  }
}

// Every tree of both measured stands becomes a valid prototype of its own measures.
TEST(CrownPrototype, AllTreesOfTheMeasuredStands) {
  const SpeciesLibrary library = SpeciesLibrary::load(test::source_dir() / "configs/species");
  for (const char* stand : {"stands/bechefa/trees.csv", "stands/cloture20/trees.csv"}) {
    const auto path = test::shared_data(stand);
    if (!path) GTEST_SKIP() << "measured stand is absent";
    std::ifstream in(*path);
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
      std::vector<std::string> cell;
      std::istringstream cells(line);
      for (std::string each; std::getline(cells, each, ',');) cell.push_back(each);
      const auto number = [&](std::size_t column) { return std::stod(cell.at(column)); };
      const CrownShape crown{
          number(6), number(7), number(8), {number(9), number(11), number(10), number(12)}, number(4) / 100};
      const double area_m2 = number(13) * crown_volume_m3(crown);
      const Prototype tree = crown_prototype(library.find(cell.at(1), stand), crown, {area_m2, 200, 1});
      EXPECT_NO_THROW(validate(tree, line));
      EXPECT_NEAR(measure(tree).dbh_m, crown.dbh_m, 1e-5 * crown.dbh_m) << line;
      EXPECT_NEAR(leaf_area_m2(tree) / area_m2, 1.0, 1e-5) << line;
      EXPECT_GE(prototype_bounds(tree).lo.z, -1e-5) << line;
    }
  }
}

}  // namespace
}  // namespace sunfleck
