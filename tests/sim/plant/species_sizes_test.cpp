// Seven species, open-grown and stand-grown, in eight sizes: every one meets the allometry of its species,
// has elements of the species' size, wood that hangs together and narrows by the pipe model, and no wood in
// wood.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "sim/base/error.h"
#include "sim/plant/grow_foliage.h"
#include "sim/plant/make_prototype.h"
#include "sim/plant/wood_contacts.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

struct Case {
  const char* species;
  TreeForm form;
  double dbh_cm;
};
std::string name_of(const Case& one) {
  return std::string(one.species) + (one.form == TreeForm::kOpenGrown ? "_open_" : "_stand_") +
         std::to_string(static_cast<int>(one.dbh_cm));
}
void PrintTo(const Case& one, std::ostream* out) { *out << name_of(one); }

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const char* species : {"picea_abies", "abies_alba", "pinus_sylvestris", "larix_decidua",
                              "fagus_sylvatica", "quercus_robur", "betula_pendula"})
    for (const TreeForm form : {TreeForm::kStandGrown, TreeForm::kOpenGrown})
      for (const double dbh_cm : {5., 8., 12., 18., 25., 35., 45., 60.})
        cases.push_back({species, form, dbh_cm});
  return cases;
}

class SpeciesSize : public testing::TestWithParam<Case> {};

// DBH and leaf area are scaled to, so only rounding is left; the outline is fitted in rounds, to the part of
// a leaf that does not scale with it: 2 % (asked: 5 % of DBH and leaf area, 10 % of the rest).
void expect_size(const Prototype& tree, const TreeSize& size) {
  const TreeMeasures m = measure(tree);
  EXPECT_NEAR(m.dbh_m, size.dbh_m, 1e-4 * size.dbh_m);
  EXPECT_NEAR(m.leaf_area_m2, size.leaf_area_m2, 1e-4 * size.leaf_area_m2);
  EXPECT_NEAR(m.height_m, size.height_m, 0.02 * size.height_m);
  EXPECT_NEAR(m.crown_base_m, size.crown_base_m, 0.02 * size.crown_base_m);
  EXPECT_NEAR(m.crown_radius_m, size.crown_radius_m, 0.02 * size.crown_radius_m);
}

// Parents of the wood; every segment but the lowest stands on another.
std::vector<std::int32_t> connected(const Prototype& tree) {
  const std::vector<std::int32_t> parents = wood_parents(tree.wood);
  EXPECT_EQ(std::count(parents.begin(), parents.end(), -1), 1);
  return parents;
}

// Cross-section kept at forks (exponent 2); disused pipes only thicken below, and twigs taken away leave
// their pipes: so the children together are never thicker than their parent, to rounding.
void expect_pipe_model(const Prototype& tree, const std::vector<std::int32_t>& parents) {
  std::vector<double> above(tree.wood.size(), 0);
  for (std::size_t i = 0; i < tree.wood.size(); ++i)
    if (parents[i] >= 0)
      above[static_cast<std::size_t>(parents[i])] += std::pow(tree.wood[i].radius_from_m, 2);
  std::size_t thicker = 0;
  for (std::size_t i = 0; i < tree.wood.size(); ++i)
    if (above[i] > 1.0001 * std::pow(tree.wood[i].radius_from_m, 2)) ++thicker;
  EXPECT_EQ(thicker, 0u);
}

TEST_P(SpeciesSize, IsATreeOfItsSpecies) {
  const Case& one = GetParam();
  const Species species =
      load_species(test::source_dir() / "configs/species" / (std::string(one.species) + ".toml"));
  const TreeSize size = expected_size(species, one.dbh_cm, one.form);
  const Prototype tree = grow_prototype(species, size, 1, 1);
  expect_size(tree, size);
  const double usual_m2 = template_area_m2(species.foliage);
  EXPECT_GT(tree.foliage.front().area_m2, 0.8 * usual_m2);
  EXPECT_LT(tree.foliage.front().area_m2, 1.25 * usual_m2);
  const std::vector<std::int32_t> parents = connected(tree);
  expect_pipe_model(tree, parents);
  // Taken away in the tree with all its leaves; with those it keeps it is fitted again, which moves wood by
  // parts of a per cent: a twentieth of the thinner radius may be left.
  EXPECT_TRUE(wood_contacts(tree.wood, parents, 0.05).empty());
}

INSTANTIATE_TEST_SUITE_P(All, SpeciesSize, testing::ValuesIn(all_cases()),
                         [](const auto& one) { return name_of(one.param); });

// Light took the lower branches of trees in stands: longer boles, shorter crowns than of trees alone; those
// are never taller.
TEST(SpeciesForms, StandGrownTreesHaveAClearBole) {
  const SpeciesLibrary library = SpeciesLibrary::load(test::source_dir() / "configs/species");
  int species_seen = 0;
  for (const Species& species : library.all()) {
    if (!species.open_grown) continue;
    ++species_seen;
    for (const double dbh_cm : {12.0, 25.0, 45.0}) {
      const TreeSize stand = expected_size(species, dbh_cm);
      const TreeSize open = expected_size(species, dbh_cm, TreeForm::kOpenGrown);
      EXPECT_GT(stand.crown_base_m, 1.15 * open.crown_base_m) << species.latin;
      EXPECT_LE(open.height_m, stand.height_m);
      // Measured ratios of the species' data: spruce .553, fir .674, beech .733.
      const double ratio = 1 - stand.crown_base_m / stand.height_m;
      EXPECT_NEAR(ratio, species.crown_length_ratio, 1e-12);
    }
  }
  EXPECT_EQ(species_seen, 7);
}

TEST(SpeciesForms, OpenGrownNeedsItsNumbers) {
  const SpeciesLibrary library = SpeciesLibrary::load(test::source_dir() / "configs/species");
  EXPECT_THROW(expected_size(library.find("psme", "t"), 30, TreeForm::kOpenGrown), Error);
}

}  // namespace
}  // namespace sunfleck
