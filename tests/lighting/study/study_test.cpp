// A study from its configuration to its answer: sensors, energy, seasons, bad input, a measured stand.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "lighting/study/stand_study.h"
#include "sim/base/error.h"
#include "sim/forest/forest_spec.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

void expect_refused(const std::function<void()>& action, const std::string& where,
                    const std::string& problem) {
  try {
    action();
    ADD_FAILURE() << "accepted; expected " << where << ": " << problem;
  } catch (const Error& error) {
    EXPECT_NE(error.where().find(where), std::string::npos) << error.what();
    EXPECT_NE(error.problem().find(problem), std::string::npos) << error.what();
    EXPECT_FALSE(error.remedy().empty()) << error.what();
  }
}

TEST(SensorTable, ReadsNamesHeightsAndMeasurements) {
  const auto sensors =
      parse_sensors("id_sensor,x,y,h_m,pacl,pacl_direct\n7,1,2,1.5,0.11,NA\n8,3,4,2,,0.2\n", "s.csv");
  ASSERT_EQ(sensors.size(), 2u);
  EXPECT_EQ(sensors[0].sensor.name, "7");
  EXPECT_EQ(sensors[0].sensor.height_m, 1.5);
  EXPECT_EQ(*sensors[0].pacl, 0.11);
  EXPECT_FALSE(sensors[0].pacl_direct || sensors[1].pacl);
  EXPECT_EQ(*sensors[1].pacl_direct, 0.2);
}

TEST(SensorTable, RefusesWhatIsNoSensor) {
  expect_refused([] { parse_sensors("x\n1\n", "s.csv"); }, "column y", "missing");
  expect_refused([] { parse_sensors("id,x,y\n1,0,0\n1,2,2\n", "s.csv"); }, "s.csv:3", "was there before");
  expect_refused([] { parse_sensors("x,y,pacl\n0,0,23\n", "s.csv"); }, "column pacl", "percent");
  expect_refused([] { parse_sensors("x,y,h_m\n0,0,-1\n", "s.csv"); }, "column h_m", "out of range");
  expect_refused([] { parse_sensors("x,y\n", "s.csv"); }, "s.csv", "no sensors");
  expect_refused([] { read_sensors("absent.csv"); }, "absent.csv", "read");
}

// Modelled = measured + 0.1 but for one that is 0.1 under: rmse 0.1, bias 0.1 (n - 2) / n.
TEST(SensorFit, KnownFigures) {
  const SensorFit fit = sensor_fit({0.2, 0.3, 0.4, 0.4}, {0.1, 0.2, 0.3, 0.5});
  EXPECT_NEAR(fit.rmse, 0.1, 1e-12);
  EXPECT_NEAR(fit.bias, 0.05, 1e-12);
  EXPECT_NEAR(sensor_fit({1, 2, 3}, {2, 4, 6}).correlation, 1, 1e-12);
  EXPECT_TRUE(std::isnan(sensor_fit({1, 1}, {2, 3}).correlation));
}

// Ten crowns on a periodic plot, a month of radiation.
Forest small_stand() {
  ForestSpec spec;
  for (int i = 0; i < 10; ++i) {
    InventoryTree tree;
    tree.id = {static_cast<std::uint32_t>(i + 1)};
    tree.species = "beech";
    tree.x_m = 4 + 6 * (i % 4), tree.y_m = 4 + 7 * (i / 4);
    tree.dbh_cm = 25;
    spec.inventory.push_back(tree);
  }
  spec.trees = TreeSource::kCrown;
  spec.elements_per_tree = 300;
  spec.period = Period{{0, 0}, {24, 24}};
  return grow_forest(spec, SpeciesLibrary::load(test::source_dir() / "configs/species"), {});
}

StandStudySpec small_spec(const std::string& from = "2020-06-01T00:00+01:00",
                          const std::string& to = "2020-08-01T00:00+01:00") {
  const auto table = test::scratch_dir() / "radiation.csv";
  std::ofstream(table)
      << "month,global_horizontal_mj_m2,diffuse_fraction\n1,90,0.7\n6,560,0.5\n7,580,0.5\n12,70,0.7\n";
  StandStudySpec spec;
  spec.place = {50, 5};
  spec.period = parse_period(from, to, "stand_light");
  spec.radiation = table;
  spec.optics = {{"PAR"}, {0.1}, {}};
  spec.ground_cell_m = 4;
  spec.rays_per_cell = 400;
  spec.patch_deg = 12;
  spec.sensors = {{{"a", {12, 12}, 1, {0, 0, 1}}, {}, {}, {}}, {{"b", {2, 20}, 1, {0, 0, 1}}, {}, {}, {}}};
  return spec;
}

TEST(StandStudy, MonthsAddUpToThePeriodAndEnergyCloses) {
  const Forest forest = small_stand();
  const StandStudy study = run_stand_study(forest, small_spec(), {});
  ASSERT_TRUE(study.period && study.parts);
  ASSERT_EQ(study.intervals.size(), 3u);  // the whole and two months
  EXPECT_NEAR(study.direct_horizontal_mj_m2[0] + study.diffuse_horizontal_mj_m2[0], 1140, 1e-6);
  const PlotTables& plot = study.period->plot;
  const double sent = plot.sent[0];
  EXPECT_NEAR((plot.leaves[0] + plot.wood[0] + plot.ground[0] + plot.beyond[0] + plot.missed[0]) / sent, 1,
              1e-6);
  for (std::size_t tree = 0; tree < forest.instances.size(); ++tree) {
    const double months =
        study.parts->trees.intercepted.at(0, tree) + study.parts->trees.intercepted.at(1, tree);
    EXPECT_NEAR(months / study.period->trees.intercepted.at(0, tree), 1, 1e-4);
  }
  for (std::size_t s = 0; s < 2; ++s) {
    EXPECT_GT(study.period->sensors.pacl_total.at(0, s), 0);
    EXPECT_LT(study.period->sensors.pacl_total.at(0, s), 1);
  }
  EXPECT_FALSE(study.fit.has_value());  // nothing was measured
}

TEST(StandStudy, RaysAndBoxesAgreeOnThePlot) {
  const Forest forest = small_stand();
  StandStudySpec spec = small_spec();
  const StandStudy rays = run_stand_study(forest, spec, {});
  spec.engine = StandEngine::kBoxes;
  spec.ground_cell_m = 2;
  spec.intervals = IntervalKind::kPeriod;
  const StandStudy boxes = run_stand_study(forest, spec, {});
  ASSERT_TRUE(boxes.world.has_value());
  const double by_rays = rays.period->plot.ground[0] / rays.period->plot.sent[0];
  const double by_boxes = boxes.world->ground[0] / boxes.world->incident[0];
  EXPECT_NEAR(by_boxes, by_rays, 0.02);  // boxes smear leaves over a metre
}

TEST(StandStudy, PolarNightGivesZerosAndSaysSo) {
  StandStudySpec spec = small_spec("2020-12-10T00:00+01:00", "2020-12-20T00:00+01:00");
  spec.place = {78, 15};
  std::ofstream(spec.radiation) << "month,global_horizontal_mj_m2,diffuse_fraction\n12,0,1\n";
  const StandStudy study = run_stand_study(small_stand(), spec, {});
  ASSERT_TRUE(study.period.has_value());
  EXPECT_EQ(study.direct_horizontal_mj_m2[0], 0);
  for (const float v : study.period->trees.intercepted.value) EXPECT_EQ(v, 0);
  for (const float v : study.period->sensors.pacl_total.value) EXPECT_EQ(v, 0);
  ASSERT_FALSE(study.provenance.notes.empty());
}

TEST(StandStudy, BadInputIsToldBeforeAnyWork) {
  const Forest forest = small_stand();
  StandStudySpec spec = small_spec("2020-02-01T00:00+01:00", "2020-03-01T00:00+01:00");
  expect_refused([&] { run_stand_study(forest, spec, {}); }, "", "");  // February is not in the table
  spec = small_spec();
  spec.sensors[0].sensor.position_m = {500, 500};
  expect_refused([&] { run_stand_study(forest, spec, {}); }, "sensors[0]", "");
  expect_refused([&] { parse_period("2020-06-01T00:00", "2020-07-01T00:00+01:00", "stand_light"); },
                 "stand_light.from", "");
  Forest empty = forest;
  empty.instances.clear();
  expect_refused([&] { run_stand_study(empty, small_spec(), {}); }, "forest", "no trees");
}

// The measured stand, nothing fitted to its sensors. Bounds are loose: they catch a broken model, the figures
// themselves are in the README.
TEST(StandStudy, MeasuredStandAgainstItsSensors) {
  const auto folder = test::shared_data("stands/cloture20");
  if (!folder) GTEST_SKIP() << "the measured stand is absent";
  ForestSpec stand;
  stand.inventory = read_inventory(*folder / "trees.csv");
  stand.trees = TreeSource::kCrown;
  stand.elements_per_tree = 1000;
  stand.plot = read_plot_polygon(*folder / "plot_polygon.csv");
  stand.surroundings = Surroundings::kPeriodic;
  const Forest forest = grow_forest(stand, SpeciesLibrary::load(test::source_dir() / "configs/species"), {});
  StandStudySpec spec = small_spec("2011-04-01T00:00+01:00", "2011-11-01T00:00+01:00");
  spec.place = {50.03617, 5.20634, 400};
  spec.radiation = *folder / "monthly_radiation.csv";
  spec.sensors = read_sensors(*folder / "sensors_measured.csv");
  spec.intervals = IntervalKind::kPeriod;
  spec.scattering = false;
  spec.canopy_views = false;
  spec.rays_per_cell = 50;
  const StandStudy study = run_stand_study(forest, spec, {});
  ASSERT_TRUE(study.fit.has_value());
  std::printf("measured stand: rmse %.4f, bias %+.4f, correlation %.3f over %zu sensors\n", study.fit->rmse,
              study.fit->bias, study.fit->correlation, study.fit->sensors);
  EXPECT_EQ(study.fit->sensors, 16u);
  EXPECT_LT(study.fit->rmse, 0.15);
  EXPECT_LT(std::fabs(study.fit->bias), 0.1);
}

}  // namespace
}  // namespace sunfleck
