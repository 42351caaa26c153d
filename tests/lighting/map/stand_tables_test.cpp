// The numbers of a study as tables: sums, units, trees of the inventory only; and the same numbers in CSV.
#include <gtest/gtest.h>

#include <cmath>

#include "lighting/map/ground_picture.h"
#include "lighting/map/stand_csv.h"
#include "sim/base/error.h"
#include "sim/forest/csv_table.h"
#include "tests/lighting/map/example_study.h"

namespace sunfleck {
namespace {

namespace fs = std::filesystem;
using test::example_study;

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(StandTables, EveryVariableHasOneValueForEveryTargetAndInterval) {
  const StandTables& t = example_study().tables;
  ASSERT_EQ(t.intervals.size(), 3u);  // the period, May, June
  ASSERT_EQ(t.begin_s.size(), 3u);
  EXPECT_EQ(t.begin_s[0], t.begin_s[1]);
  EXPECT_EQ(t.end_s[1], t.begin_s[2]);
  EXPECT_EQ(t.end_s[0], t.end_s[2]);
  EXPECT_EQ(t.tables.size(), 7u);
  for (const StandTable& table : t.tables)
    for (const StandVariable& v : table.variables) {
      const std::size_t each = table.rows * static_cast<std::size_t>(std::max(1, v.rings));
      EXPECT_EQ(v.value.size(), each * (v.per_interval ? 3 : 1)) << to_string(table.target) << v.name;
      EXPECT_TRUE(v.standard_error.empty() || v.standard_error.size() == v.value.size()) << v.name;
      EXPECT_FALSE(v.long_name.empty() || v.units.empty()) << v.name;
      for (const double x : v.value)
        EXPECT_TRUE(std::isfinite(x) || v.name.starts_with("measured")) << v.name;
    }
}

// Energies of the months add up to the period's; photons are energy times the stated factors.
TEST(StandTables, MonthsAddUpAndPhotonsFollowFromEnergy) {
  const StandTables& t = example_study().tables;
  const std::size_t trees = t.trees.size();
  for (const char* name : {"intercepted", "potential", "absorbed_par", "absorbed_nir"}) {
    const StandVariable& v = *t.find(StandTarget::kTree, name);
    for (std::size_t k = 0; k < trees; ++k)  // floats of the engine: 1e-5
      EXPECT_NEAR(v.value[k], v.value[trees + k] + v.value[2 * trees + k], 1e-5 * v.value[k]) << name;
  }
  const StandVariable& par = *t.find(StandTarget::kTree, "absorbed_par");
  const StandVariable& mol = *t.find(StandTarget::kTree, "absorbed_par_photons");
  for (std::size_t k = 0; k < par.value.size(); ++k)
    EXPECT_NEAR(mol.value[k], t.par.umol_per_j * par.value[k], 1e-9 * mol.value[k]);
  // 520 + 560 MJ m-2 of global radiation were asked for.
  const StandVariable& open = *t.find(StandTarget::kPlot, "open_global");
  EXPECT_NEAR(open.value[0], 1080, 0.1);
  EXPECT_NEAR(t.find(StandTarget::kPlot, "open_par_photons")->value[0], open.value[0] * 0.47 * 4.57, 1e-6);
}

TEST(StandTables, TreesNobodyMeasuredAreLeftOutUnlessAskedFor) {
  const auto& e = example_study();
  EXPECT_EQ(e.tables.trees.size(), 9u);
  EXPECT_GT(e.tables.virtual_trees, 3u);
  EXPECT_EQ(e.tables.trees.front().id, 100u);
  EXPECT_EQ(e.tables.trees.front().species, "Picea abies");
  const StandTables all = stand_tables(e.study, e.forest, {.virtual_trees = true});
  EXPECT_EQ(all.trees.size(), e.forest.instances.size());
  double own_m2 = 0;
  for (const TreeRow& tree : e.tables.trees) own_m2 += tree.leaf_area_m2;
  EXPECT_NEAR(e.tables.find(StandTarget::kPlot, "leaf_area_index")->value[0], own_m2 / 324, 1e-6);
  StandStudy no_plot = e.study;
  no_plot.spec.plot_area_m2 = 0;
  EXPECT_GT(plot_figures(no_plot, e.forest).find("leaf_area_index")->value[0], own_m2 / 324);
  // Absorbed by the plot's own trees / what falls on the plot.
  double absorbed = 0;
  for (std::size_t k = 0; k < 9; ++k) absorbed += e.tables.find(StandTarget::kTree, "absorbed_par")->value[k];
  EXPECT_NEAR(e.tables.find(StandTarget::kPlot, "absorbed_fraction_par")->value[0],
              absorbed / (324 * 1080 * e.tables.par.par_fraction), 1e-3);
}

TEST(StandTables, LargeStandsHaveGroundAndTrees) {
  StandStudySpec spec = test::example_study_spec();
  spec.engine = StandEngine::kBoxes;
  spec.map_lo_m.reset(), spec.map_hi_m.reset();
  const StandStudy study = run_stand_study(example_study().forest, spec, {});
  const StandTables t = stand_tables(study, example_study().forest);
  ASSERT_TRUE(t.find(StandTarget::kTree) && t.find(StandTarget::kGround));
  EXPECT_EQ(t.find(StandTarget::kSensor), nullptr);
  const StandVariable& taken = *t.find(StandTarget::kTree, "intercepted");
  ASSERT_EQ(taken.value.size(), 27u);
  for (std::size_t k = 0; k < 9; ++k)
    EXPECT_NEAR(taken.value[k], taken.value[9 + k] + taken.value[18 + k], 1e-4 * taken.value[k]);
  const StandVariable &total = *t.find(StandTarget::kGround, "total"),
                      &share = *t.find(StandTarget::kGround, "pacl_total");
  ASSERT_EQ(total.value.size(), 3 * t.map.count());
  // On level ground the open light per area of map is the 1080 MJ m-2 asked for.
  for (std::size_t c = 0; c < t.map.count(); ++c) EXPECT_NEAR(share.value[c], total.value[c] / 1080, 1e-3);
  EXPECT_FALSE(save_stand_csv(t, test::scratch_dir() / "boxes").empty());
}

TEST(StandCsv, HoldsTheSameNumbersWithUnitsInTheNames) {
  const StandTables& t = example_study().tables;
  const fs::path folder = test::scratch_dir() / "csv";
  EXPECT_EQ(save_stand_csv(t, folder).size(), 6u);
  const CsvTable trees(content(folder / "trees.csv"), "trees.csv");
  ASSERT_EQ(trees.rows(), 27u);
  const StandVariable& par = *t.find(StandTarget::kTree, "absorbed_par");
  const auto column = trees.required_column("absorbed_par_mj");
  const auto error = trees.required_column("absorbed_par_standard_error_mj");
  for (std::size_t r = 0; r < 27; ++r) {
    EXPECT_EQ(std::stod(trees.field(r, column)), par.value[r]);
    EXPECT_EQ(std::stod(trees.field(r, error)), par.standard_error[r]);
  }
  EXPECT_EQ(trees.field(0, trees.required_column("interval")), "period");
  EXPECT_EQ(trees.field(9, trees.required_column("interval")), "2020-05");
  EXPECT_EQ(trees.field(9, trees.required_column("begin")), "2020-05-01T00:00+01:00");
  const CsvTable sensors(content(folder / "sensors.csv"), "sensors.csv");
  ASSERT_EQ(sensors.rows(), 9u);
  EXPECT_EQ(sensors.field(0, sensors.required_column("sensor")), test::kAwkwardName);
  EXPECT_EQ(sensors.field(1, sensors.required_column("sensor")), "2");
  EXPECT_EQ(sensors.field(1, sensors.required_column("measured_pacl")), "");
  EXPECT_TRUE(sensors.column("gap_fraction_0_10_deg") &&
              sensors.column("gap_fraction_80_90_deg_standard_error"));
  const CsvTable layers(content(folder / "layers.csv"), "layers.csv");
  EXPECT_EQ(layers.rows(), 3 * t.find(StandTarget::kLayer)->rows);
  EXPECT_EQ(CsvTable(content(folder / "ground.csv"), "g").rows(), 3u * 16);
  EXPECT_EQ(CsvTable(content(folder / "plot.csv"), "p").rows(), 3u);
  EXPECT_EQ(CsvTable(content(folder / "leaf_projection.csv"), "a").rows(), t.angles_deg.size());
  EXPECT_THROW(save_stand_csv(t, "/nonexistent/folder"), Error);
}

// No sun in December north of the polar circle: zeros everywhere, no error, nothing that is not a number.
TEST(StandTables, PolarNightIsZeroNotAnError) {
  StandStudySpec spec = test::example_study_spec();
  spec.place = {80, 15};
  spec.period = parse_period("2020-12-05T00:00Z", "2020-12-20T00:00Z", "stand_light");
  std::ofstream(spec.radiation) << "month,global_horizontal_mj_m2,diffuse_fraction\n12,0,0.5\n";
  const StandTables t =
      stand_tables(run_stand_study(example_study().forest, spec, {}), example_study().forest);
  for (const auto& [target, name] : {std::pair{StandTarget::kTree, "intercepted"},
                                     {StandTarget::kGround, "total"},
                                     {StandTarget::kSensor, "pacl_total"},
                                     {StandTarget::kPlot, "open_global"}})
    for (const double x : t.find(target, name)->value) EXPECT_EQ(x, 0) << name;
  EXPECT_FALSE(save_stand_csv(t, test::scratch_dir() / "night").empty());
  test::example_study_spec();  // the table the other tests read
}

TEST(GroundPicture, IsDrawnAndRefusesWhatDoesNotFit) {
  const StandTables& t = example_study().tables;
  GroundPicture picture{"light \"on\" the ground", "share (%)", std::vector<double>(t.map.count(), 20.0)};
  picture.stems = {{{3, 3}, 0.5}};
  picture.sensors = {{{9, 9}, 0, test::kAwkwardName}};
  const fs::path file = test::scratch_dir() / "ground.png";
  draw_ground(t.map, picture, file);
  EXPECT_EQ(content(file).substr(1, 3), "PNG");
  EXPECT_THROW(draw_ground(t.map, picture, test::scratch_dir() / "ground.jpg"), Error);
  picture.value.pop_back();
  EXPECT_THROW(draw_ground(t.map, picture, file), Error);
}

}  // namespace
}  // namespace sunfleck
