// Forests of crowns: trees stand where their rows say, their crowns are what was measured, leaf area is
// density times volume, and neither threads nor other trees change a tree.

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "sim/base/parallel.h"
#include "sim/forest/forest_spec.h"
#include "tests/sim/forest/expect_refusal.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

SpeciesLibrary shipped_species() { return SpeciesLibrary::load(test::source_dir() / "configs/species"); }

InventoryTree tree(std::uint32_t id, const std::string& species, double x_m, double y_m, double dbh_cm) {
  InventoryTree row;
  row.id = {id};
  row.species = species;
  row.x_m = x_m;
  row.y_m = y_m;
  row.dbh_cm = dbh_cm;
  return row;
}

ForestSpec crowns_of(std::vector<InventoryTree> trees, int elements = 200) {
  ForestSpec spec;
  spec.trees = TreeSource::kCrown;
  spec.elements_per_tree = elements;
  spec.inventory = std::move(trees);
  return spec;
}

ForestSpec three_trees() {
  return crowns_of(
      {tree(7, "spruce", 1, 2, 30), tree(3, "Fagus sylvatica", -4, 8, 25), tree(9, "FASY", 12, 0, 40)});
}

TEST(GrowCrowns, TreesStandOnTheGround) {
  ForestSpec spec = three_trees();
  spec.terrain = {250, kPi / 9, kPi / 2};  // falls 20 degrees towards east
  spec.period = Period{{-10, -10}, {30, 30}};
  spec.name = "three";
  const Forest forest = grow_forest(spec, shipped_species(), {});
  EXPECT_EQ(forest.name, "three");
  EXPECT_EQ(forest.terrain, spec.terrain);
  EXPECT_EQ(forest.period, spec.period);
  ASSERT_EQ(forest.instances.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const Instance& instance = forest.instances[i];
    EXPECT_EQ(instance.tree, spec.inventory[i].id);
    EXPECT_EQ(instance.position_m.x, spec.inventory[i].x_m);
    EXPECT_EQ(instance.position_m.y, spec.inventory[i].y_m);
    EXPECT_NEAR(instance.position_m.z, 250 - std::tan(kPi / 9) * spec.inventory[i].x_m, 1e-12);
    EXPECT_EQ(instance.scale, 1.0F);
    EXPECT_EQ(forest.prototypes[instance.prototype.value].foliage.size(), 200U);
  }
}

TEST(GrowCrowns, MaterialsAreThoseInUseByName) {
  const Forest forest = grow_forest(three_trees(), shipped_species(), {});
  ASSERT_EQ(forest.materials.size(), 2U);
  EXPECT_EQ(forest.materials[0].name, "Fagus sylvatica");
  EXPECT_EQ(forest.materials[1].name, "Picea abies");
}

// Where nothing but the diameter is known, size and leaf area are those of the species' allometry.
TEST(GrowCrowns, MissingColumnsComeFromAllometry) {
  const SpeciesLibrary library = shipped_species();
  const Forest forest = grow_forest(crowns_of({tree(1, "beech", 0, 0, 33)}, 4000), library, {});
  const Species& beech = library.find("beech", "test");
  const TreeMeasures measured = measure(forest.prototypes[0]);
  EXPECT_NEAR(measured.leaf_area_m2, beech.leaf_area_m2(33), 1e-5 * measured.leaf_area_m2);  // float areas
  EXPECT_NEAR(measured.dbh_m, 0.33, 1e-3);
  EXPECT_NEAR(measured.height_m, beech.height_m(33), 0.3);  // leaves and stem end within a leaf of the top
  // Few of 4000 evenly spread leaves lie in the outermost tenth of a radius: 10 % for radius and base.
  EXPECT_NEAR(measured.crown_radius_m, beech.crown_radius_m(33), 0.1 * beech.crown_radius_m(33));
  EXPECT_NEAR(measured.crown_base_m, beech.crown_base_m(33), 0.1 * beech.height_m(33));
}

TEST(GrowCrowns, SomeMissingColumnsFollowTheMeasuredOnes) {
  InventoryTree row = tree(1, "beech", 0, 0, 20);
  row.widest_m = 3;    // under the usual crown base of such a beech
  row.radius_n_m = 2;  // the other radii follow
  const Forest forest = grow_forest(crowns_of({row}, 2000), shipped_species(), {});
  const TreeMeasures measured = measure(forest.prototypes[0]);
  EXPECT_LT(measured.crown_base_m, 3);
  EXPECT_NEAR(measured.crown_radius_m, 2, 0.2);
}

TEST(GrowCrowns, SameBytesForAnyThreads) {
  const SpeciesLibrary library = shipped_species();
  ForestSpec spec = three_trees();
  for (std::uint32_t i = 10; i < 40; ++i) spec.inventory.push_back(tree(i, "spruce", i, i, 20 + i));
  std::string one, two;
  with_threads(1, [&] { one = content_hash(grow_forest(spec, library, {})); });
  with_threads(2, [&] { two = content_hash(grow_forest(spec, library, {})); });
  EXPECT_EQ(one, two);
  spec.seed = 2;
  EXPECT_NE(one, content_hash(grow_forest(spec, library, {})));
}

TEST(GrowCrowns, ATreeDoesNotDependOnOthers) {
  ForestSpec spec = three_trees();
  const Forest all = grow_forest(spec, shipped_species(), {});
  spec.inventory.erase(spec.inventory.begin());
  const Forest fewer = grow_forest(spec, shipped_species(), {});
  EXPECT_EQ(fewer.prototypes[1].foliage[17].centre_m, all.prototypes[2].foliage[17].centre_m);
}

// ---- measured stands

// Eight eighths of ellipsoids: sum over quadrants of pi/6 a b c = pi/6 (rn + rs) (re + rw) (h - hbase).
double volume_m3(const InventoryTree& t) {
  return kPi / 6 * (*t.radius_n_m + *t.radius_s_m) * (*t.radius_e_m + *t.radius_w_m) *
         (*t.height_m - *t.crown_base_m);
}

// 1 on the surface of the measured crown, less inside; p relative to the stem foot.
double crown_reach(const InventoryTree& t, const Vec3& p) {
  const double a_m = p.x >= 0 ? *t.radius_e_m : *t.radius_w_m, b_m = p.y >= 0 ? *t.radius_n_m : *t.radius_s_m;
  const double c_m = p.z >= *t.widest_m ? *t.height_m - *t.widest_m : *t.widest_m - *t.crown_base_m;
  return std::hypot(p.x / a_m, p.y / b_m, (p.z - *t.widest_m) / c_m);
}

void expect_crowns_as_measured(const ForestSpec& spec, const Forest& forest) {
  const ForestIndex index(forest);
  double expected_area_m2 = 0;
  for (std::size_t i = 0; i < spec.inventory.size(); ++i) {
    const InventoryTree& row = spec.inventory[i];
    expected_area_m2 += *row.leaf_area_density_per_m * volume_m3(row);
    double farthest = 0;
    for (std::size_t e = 0; e < static_cast<std::size_t>(spec.elements_per_tree); ++e) {
      const Vec3 foot_m{row.x_m, row.y_m, forest.terrain.height_at(row.x_m, row.y_m)};
      const double reach = crown_reach(row, world_element(forest, i, e).centre_m - foot_m);
      farthest = std::max(farthest, reach);
      ASSERT_LE(reach, 1 + 1e-3) << "tree " << row.id.value;  // floats at the 1 cm radii of two trees
    }
    // Of n points even in volume the farthest is over 0.8 but for 0.8^(3n): 1e-29 for 100.
    EXPECT_GT(farthest, 0.8) << "tree " << row.id.value;
  }
  EXPECT_NEAR(forest_leaf_area_m2(forest), expected_area_m2, 1e-4 * expected_area_m2);
}

TEST(MeasuredStand, Cloture20) {
  const auto file = test::shared_data("stands/cloture20/trees.csv");
  if (!file) GTEST_SKIP() << "measured stand is absent";
  const ForestSpec spec = crowns_of(read_inventory(*file), 1000);
  const Forest forest = grow_forest(spec, shipped_species(), {});
  EXPECT_EQ(forest.instances.size(), 112U);
  EXPECT_GE(ForestIndex(forest).element_count(), 100'000U);
  EXPECT_EQ(forest.materials.size(), 2U);  // beech and oak
  expect_crowns_as_measured(spec, forest);
}

TEST(MeasuredStand, BechefaOnASlope) {
  const auto file = test::shared_data("stands/bechefa/trees.csv");
  if (!file) GTEST_SKIP() << "measured stand is absent";
  ForestSpec spec = crowns_of(read_inventory(*file), 100);
  spec.terrain = {300, 0.2, 1.0};
  const Forest forest = grow_forest(spec, shipped_species(), {});
  EXPECT_EQ(forest.instances.size(), 201U);
  EXPECT_EQ(forest.materials.size(), 4U);
  expect_crowns_as_measured(spec, forest);
}

// ---- planting, progress, stopping

TEST(GrowForest, PlantedTreesGrowAndShortfallsAreSaid) {
  ForestSpec spec = crowns_of({}, 10);
  spec.planting = {{"spruce", 500, PlantingPattern::kPoissonDisc, 4, 25, 5}};
  spec.plot_width_m = spec.plot_depth_m = 20;
  std::set<std::string> stages;
  std::vector<std::string> notes;
  const Forest forest = grow_forest(
      spec, shipped_species(), {{}, [&](std::string_view stage, double) { stages.emplace(stage); }}, &notes);
  EXPECT_GT(forest.instances.size(), 10U);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_TRUE(notes[0].starts_with("forest.planting[0]: " + std::to_string(forest.instances.size()) +
                                   " of 500 spruce fit"))
      << notes[0];
  EXPECT_EQ(stages, std::set<std::string>{"growing trees"});  // a note is no stage
}

TEST(GrowForest, StopsInTheMiddle) {
  ForestSpec spec = three_trees();
  for (std::uint32_t i = 10; i < 200; ++i) spec.inventory.push_back(tree(i, "spruce", i, i, 20));
  std::stop_source source;
  double last = 0;
  const RunControl control{source.get_token(), [&](std::string_view, double fraction) {
                             last = fraction;
                             if (fraction > 0.3) source.request_stop();
                           }};
  test::expect_refusal(
      [&] {
        try {
          grow_forest(spec, shipped_species(), control);
        } catch (const Error& error) {
          throw Error(error.kind(), "stopped", error.what(), "-");
        }
      },
      ErrorKind::kCancelled, "stopped", "");
  EXPECT_LT(last, 0.6);
}

// ---- bad input

TEST(GrowForest, MessagesNameTheRowAndEachSpeciesOnce) {
  ForestSpec spec = crowns_of(parse_inventory("id_tree,species,x,y,dbh_cm\n5,unicorn,0,0,20\n", "a.csv"));
  const SpeciesLibrary library = shipped_species();
  try {
    grow_forest(spec, library, {});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), "a.csv:2: tree 5 (unicorn)");
    for (const Species& species : library.all()) {
      const std::size_t first = error.remedy().find(species.latin);
      EXPECT_NE(first, std::string::npos) << error.remedy();
      EXPECT_EQ(error.remedy().find(species.latin, first + 1), std::string::npos) << error.remedy();
    }
  }
  spec.inventory.clear();
  spec.planting = {{"unicorn", 3, PlantingPattern::kRandom, 4, 25, 5}};
  spec.plot_width_m = spec.plot_depth_m = 20;
  test::expect_refusal([&] { grow_forest(spec, library, {}); }, ErrorKind::kInvalidInput,
                       "forest.planting[0]: tree 1", "unicorn");
}

TEST(GrowForest, BadSpecsAreRefused) {
  const double nan = std::nan("");
  struct Case {
    const char *where, *problem;
    std::function<void(ForestSpec&)> spoil;
  };
  const std::vector<Case> cases{
      {"forest", "no trees", [](ForestSpec& s) { s.inventory.clear(); }},
      {"forest", "an inventory and planting", [](ForestSpec& s) { s.planting.push_back({}); }},
      {"tree 3", "palm", [](ForestSpec& s) { s.inventory[1].species = "palm"; }},
      {"tree 3", "diameter", [](ForestSpec& s) { s.inventory[1].dbh_cm = -1; }},
      {"tree 3", "diameter", [&](ForestSpec& s) { s.inventory[1].dbh_cm = nan; }},
      {"tree 3", "position", [&](ForestSpec& s) { s.inventory[1].x_m = nan; }},
      {"tree 3", "position", [](ForestSpec& s) { s.inventory[1].y_m = INFINITY; }},
      {"tree 3", "height", [&](ForestSpec& s) { s.inventory[1].height_m = nan; }},
      {"tree 3", "upside down",
       [](ForestSpec& s) { s.inventory[1].height_m = 9, s.inventory[1].crown_base_m = 10; }},
      {"tree 3", "upside down",
       [](ForestSpec& s) { s.inventory[1].height_m = 9, s.inventory[1].widest_m = 10; }},
      {"tree 3", "radius", [](ForestSpec& s) { s.inventory[1].radius_e_m = -2; }},
      {"tree 3", "radii are 0", [](ForestSpec& s) { s.inventory[1].radius_e_m = 0; }},
      {"tree 3", "crown_lad", [&](ForestSpec& s) { s.inventory[1].leaf_area_density_per_m = nan; }},
      {"tree 3", "no foliage area", [](ForestSpec& s) { s.inventory[1].leaf_area_density_per_m = 0; }},
      {"tree 9", "this number", [](ForestSpec& s) { s.inventory[0].id = s.inventory[2].id; }},
      {"elements_per_tree", "0", [](ForestSpec& s) { s.elements_per_tree = 0; }},
      {"terrain", "slope", [&](ForestSpec& s) { s.terrain.slope_rad = nan; }},
      {"period", "positive",
       [](ForestSpec& s) {
         s.period = Period{{0, 0}, {-1, 1}};
       }},
  };
  const SpeciesLibrary library = shipped_species();
  for (std::size_t i = 0; i < cases.size(); ++i) {
    SCOPED_TRACE(std::to_string(i) + ": " + cases[i].problem);
    ForestSpec spec = three_trees();
    cases[i].spoil(spec);
    test::expect_refusal([&] { grow_forest(spec, library, {}); }, ErrorKind::kInvalidInput, cases[i].where,
                         cases[i].problem);
  }
  ForestSpec spec = three_trees();
  spec.elements_per_tree = 100'000'000;
  test::expect_refusal([&] { grow_forest(spec, library, {}); }, ErrorKind::kLimitExceeded,
                       "elements_per_tree", "too many");
}

}  // namespace
}  // namespace sunfleck
