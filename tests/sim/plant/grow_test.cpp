// Growing: pipe model, detail, seeds, mistakes, and drawings of plain grammars as prototypes.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include "sim/base/error.h"
#include "sim/lsystem/lsystem.h"
#include "sim/plant/grow_wood.h"
#include "sim/plant/make_prototype.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

Species pine() { return load_species(test::source_dir() / "configs/species/pinus_sylvestris.toml"); }

bool same(const Prototype& a, const Prototype& b) {
  if (a.foliage.size() != b.foliage.size() || a.wood.size() != b.wood.size()) return false;
  for (std::size_t i = 0; i < a.foliage.size(); ++i)
    if (a.foliage[i].centre_m != b.foliage[i].centre_m || a.foliage[i].half_u_m != b.foliage[i].half_u_m)
      return false;
  for (std::size_t i = 0; i < a.wood.size(); ++i)
    if (a.wood[i].to_m != b.wood[i].to_m || a.wood[i].radius_to_m != b.wood[i].radius_to_m) return false;
  return true;
}

// A binary tree of 2^k tips (k forks above the root segment): r_base = r0 * 2^(k/e), golden case pipe_model.
TEST(PipeModel, BinaryTreeOfTheGoldenVectors) {
  const auto grammar = lsystem::Grammar::parse(
      "#define k 10\nsymbols: A(1)\naxiom: A(k)\ndecomposition:\nA(n) : n > 0 --> F [+A(n-1)] "
      "[-A(n-1)]\nA(n) --> F\n",
      "pipes");
  const lsystem::Drawing drawing = grammar.interpret(grammar.derive({}), lsystem::StartFrame::kTree);
  ASSERT_EQ(drawing.segments.size(), 2047u);
  const nlohmann::json file = test::golden("lsystem.json");
  int cases = 0;
  for (const auto& one : file["cases"]) {
    if (one["id"] != "pipe_model") continue;
    for (const auto& expected : one["expected"]) {
      const double base = expected["r0"].get<double>() * pipe_radii(drawing, expected["e"])[0];
      EXPECT_NEAR(base, expected["r_base"].get<double>(), 1e-9);
      ++cases;
    }
  }
  EXPECT_EQ(cases, 5);
}

// Every fork of a grown tree keeps r_parent^e = sum r_child^e: the foot carries one pipe per organ.
TEST(PipeModel, OrgansFeedThePipes) {
  const auto grammar = lsystem::Grammar::parse(
      "symbols: Leaf\norgans: Leaf\naxiom: F[+F Leaf Leaf][-F Leaf]F Leaf F\n", "pipes");
  const lsystem::Drawing drawing = grammar.interpret(grammar.axiom(), lsystem::StartFrame::kTree);
  const std::vector<double> radii = pipe_radii(drawing, 2);
  // Tips: 2 and 1 organs; the leader 1 organ and a dead end above it (1 pipe) = 2; foot 2 + 1 + 2.
  const double pipes[] = {5, 2, 1, 2, 1};
  ASSERT_EQ(radii.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(radii[i], std::sqrt(pipes[i]), 1e-12) << i;
}

TEST(Grow, SameSeedSameTreeOtherSeedOther) {
  const Species species = pine();
  const TreeSize size = expected_size(species, 20);
  const Prototype tree = grow_prototype(species, size, 5, 0.7);
  EXPECT_TRUE(same(tree, grow_prototype(species, size, 5, 0.7)));
  EXPECT_FALSE(same(tree, grow_prototype(species, size, 6, 0.7)));
}

// A share of n elements is drawn one by one: sd sqrt(n p (1-p)); five of them, false alarm 6e-7.
TEST(Grow, DetailThinsAndKeepsTheLeafArea) {
  const Species species = pine();
  const TreeSize size = expected_size(species, 30);
  const auto all = static_cast<double>(grow_prototype(species, size, 1, 1).foliage.size());
  for (const double detail : {0.5, 0.1, 0.01}) {
    const Prototype tree = grow_prototype(species, size, 1, detail);
    EXPECT_NEAR(static_cast<double>(tree.foliage.size()), detail * all, 5 * std::sqrt(detail * all))
        << detail;
    EXPECT_NEAR(leaf_area_m2(tree), size.leaf_area_m2, 1e-4 * size.leaf_area_m2) << detail;
    EXPECT_NEAR(measure(tree).crown_radius_m, size.crown_radius_m, 0.02 * size.crown_radius_m) << detail;
  }
}

// Shoots keep needles per silhouette: the area grows with the square of the length.
TEST(Grow, EnlargedShootsKeepTheirProportions) {
  const Species species = pine();
  const Prototype tree = grow_prototype(species, expected_size(species, 30), 1, 0.25);
  const FoliageElement& e = tree.foliage.front();
  const double scale = 2 * glm::length(e.half_u_m) / species.foliage.shoot_length_m;
  EXPECT_NEAR(glm::length(e.half_v_m), scale * species.foliage.shoot_radius_m, 1e-6);
  EXPECT_NEAR(e.area_m2, scale * scale * species.foliage.shoot_area_m2(), 1e-4 * e.area_m2);
}

TEST(Grow, RefusesWhatCannotBe) {
  const Species species = pine();
  const TreeSize fine = expected_size(species, 20);
  const auto refused = [&](TreeSize size, double detail) {
    EXPECT_THROW(grow_prototype(species, size, 1, detail), Error);
  };
  for (const double detail : {0.0, -1.0, 1.5, std::nan("")}) refused(fine, detail);
  for (const double wrong : {0.0, -3.0, std::nan(""), 1e9}) {
    refused({wrong, fine.height_m, fine.crown_base_m, fine.crown_radius_m, fine.leaf_area_m2}, 1);
    refused(
        {fine.dbh_m, wrong == 1e9 ? 1e9 : wrong, fine.crown_base_m, fine.crown_radius_m, fine.leaf_area_m2},
        1);
    refused({fine.dbh_m, fine.height_m, wrong, fine.crown_radius_m, fine.leaf_area_m2}, 1);
    refused({fine.dbh_m, fine.height_m, fine.crown_base_m, wrong, fine.leaf_area_m2}, 1);
    refused({fine.dbh_m, fine.height_m, fine.crown_base_m, fine.crown_radius_m, wrong}, 1);
  }
  Species bare = species;
  bare.grammar.clear();
  EXPECT_THROW(grow_prototype(bare, fine, 1, 1), Error);
  bare.grammar = "absent.lsys";
  EXPECT_THROW(grow_prototype(bare, fine, 1, 1), Error);
}

std::filesystem::path written(const std::string& name, const std::string& text) {
  const std::filesystem::path path = test::scratch_dir() / name;
  std::ofstream(path) << text;
  return path;
}

TEST(FromLsystem, TurnsADrawingIntoAPlant) {
  const auto path = written(
      "plant.lsys",
      "symbols: Leaf(2) Shoot(3) A\norgans: Leaf Shoot\nwidth: 0.2\naxiom: A\nsteps: 1\n"
      "A --> F(2)[&(90)Leaf(0.1, 0.06)][Shoot(0.3, 0.05, 0.4)]@O(0.5)[&(90){.f(1)+(90)f(1)+(90)f(1)}]\n");
  const Prototype plant = prototype_from_lsystem(path, -1, 1, "green");
  ASSERT_EQ(plant.wood.size(), 1u);
  EXPECT_FLOAT_EQ(plant.wood[0].radius_from_m, 0.1f);  // widths are diameters
  EXPECT_EQ(plant.materials, std::vector<std::string>{"green"});
  ASSERT_EQ(plant.foliage.size(), 4u);
  // Leaf: 0.1 * 0.06 / 2; shoot as stated; disc pi / 4; the polygon a unit square.
  EXPECT_NEAR(plant.foliage[0].area_m2, 0.003, 1e-8);
  EXPECT_NEAR(element_geometric_area(plant.foliage[0]), 0.003, 1e-8);
  EXPECT_NEAR(element_normal(plant.foliage[0]).z, 1, 1e-6);  // pitched level, front up
  EXPECT_NEAR(plant.foliage[1].area_m2, 0.4, 1e-7);
  EXPECT_NEAR(plant.foliage[1].centre_m.z, 2.15, 1e-6);
  EXPECT_NEAR(plant.foliage[2].area_m2, kPi / 4, 1e-6);
  EXPECT_NEAR(plant.foliage[3].area_m2, 1, 1e-6);
}

TEST(FromLsystem, TellsMistakes) {
  EXPECT_THROW(prototype_from_lsystem(test::scratch_dir() / "absent.lsys", -1, 1, "m"), Error);
  EXPECT_THROW(prototype_from_lsystem(written("bad.lsys", "axiom: F Q\n"), -1, 1, "m"), Error);
  EXPECT_THROW(
      prototype_from_lsystem(written("leaf.lsys", "symbols: L(1)\norgans: L\naxiom: F L(-1)\n"), -1, 1, "m"),
      Error);
  EXPECT_THROW(prototype_from_lsystem(written("width.lsys", "axiom: !(-1) F\n"), -1, 1, "m"), Error);
}

}  // namespace
}  // namespace sunfleck
