// The estimate of leaf area from sensors: its parts on paper, a stand whose leaf area is known, bad input;
// and the measured stand with natural crowns.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>

#include "lighting/study/calibrate.h"
#include "sim/base/error.h"
#include "sim/forest/realism.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

// Published two-sided 95 % quantiles, to their last digit.
TEST(StudentT, KnownQuantiles) {
  EXPECT_NEAR(student_t(0.95, 1), 12.706, 5e-4);
  EXPECT_NEAR(student_t(0.95, 2), 4.303, 5e-4);
  EXPECT_NEAR(student_t(0.95, 7), 2.365, 5e-4);
  EXPECT_NEAR(student_t(0.95, 15), 2.131, 5e-4);
  EXPECT_NEAR(student_t(0.90, 10), 1.812, 5e-4);
}

TEST(MonotoneCubic, MeetsNodesAndNeverOvershoots) {
  const std::vector<double> x{0, 1, 2, 4}, y{1, 0.9, 0.2, 0.1};
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(monotone_cubic(x, y.data(), x[i]), y[i], 1e-14);
  double last = 2;
  for (double at = -1; at < 5; at += 0.01) {
    const double here = monotone_cubic(x, y.data(), at);
    EXPECT_LE(here, last + 1e-14);
    last = here;
  }
  EXPECT_EQ(monotone_cubic(x, y.data(), -1), 1.0);  // held at the ends
}

// Sensors under exp(-k factor), k = 0.5, 1, ...: nodes every 0.23 in the logarithm.
LightEmulator beer_emulator(std::size_t sensors) {
  LightEmulator e;
  e.axes.resize(1);
  for (int i = 0; i <= 12; ++i) {
    const double place = std::log(0.25) + i * std::log(16.0) / 12;
    e.axes[0].nodes.push_back(place);
    e.values.emplace_back();
    for (std::size_t s = 0; s < sensors; ++s)
      e.values.back().push_back(std::exp(-0.5 * static_cast<double>(s + 1) * std::exp(place)));
  }
  return e;
}

TEST(FitParameters, FindsTheFactorBehindNoisyLight) {
  const LightEmulator e = beer_emulator(6);
  const double noise[] = {0.01, -0.01, 0.01, 0.01, -0.01, -0.01};
  std::vector<double> measured;
  for (std::size_t s = 0; s < 6; ++s)
    measured.push_back(std::exp(-0.5 * static_cast<double>(s + 1) * 1.3) + noise[s]);
  const auto p = fit_parameters(e, measured, {.damping = false});
  ASSERT_EQ(p.size(), 1u);
  EXPECT_NEAR(p[0].value, 1.3, 0.06);  // 0.01 of light is about 0.03 of the factor at the best sensors
  EXPECT_LT(p[0].low, 1.3);
  EXPECT_GT(p[0].high, 1.3);
  EXPECT_FALSE(p[0].low_open || p[0].high_open || p[0].at_edge);
}

// Light at a hundredth of what any factor gives: the best is the darkest, the interval does not end.
TEST(FitParameters, SaysWhenTheIntervalIsOpen) {
  const auto p = fit_parameters(beer_emulator(3), {0.0, 0.0, 0.0}, {.damping = false});
  EXPECT_TRUE(p[0].high_open && p[0].at_edge);
}

// Four sensors that follow one factor exactly: any half tells the other but for the net's steps (1.4 %).
TEST(SplitHalf, ExactLightIsToldExactly) {
  const LightEmulator e = beer_emulator(4);
  const SplitHalf h = split_half(e, e.at({std::log(1.1)}), {.damping = false});
  EXPECT_EQ(h.splits, 6u);
  EXPECT_LT(h.rmse, 0.005);
}

// Eight sensors under one factor whose light strays from its mean by a third of what the model says: the
// share is found (no noise, so that the prior weighs nothing), the factor too, and halves tell each other.
TEST(PatternShare, FindsHowMuchOfThePatternIsReal) {
  const LightEmulator e = beer_emulator(8);
  std::vector<double> measured = e.at({std::log(1.2)});
  double mean = 0;
  for (const double v : measured) mean += v / 8;
  for (double& v : measured) v = mean + (v - mean) / 3;
  const auto p = fit_parameters(e, measured, {});
  ASSERT_EQ(p.size(), 2u);
  EXPECT_EQ(p[1].name, "pattern_share");
  EXPECT_NEAR(p[0].value, 1.2, 0.02);  // steps of the net
  EXPECT_NEAR(p[1].value, 1.0 / 3, 0.01);
  EXPECT_LE(p[1].low, 1.0 / 3);
  EXPECT_GE(p[1].high, 1.0 / 3);
  EXPECT_LT(split_half(e, measured).rmse, 0.003);
  EXPECT_GT(split_half(e, measured, {.damping = false}).rmse, 0.05);
}

// Light that strays the other way: no negative share.
TEST(PatternShare, IsNeverNegative) {
  const LightEmulator e = beer_emulator(6);
  std::vector<double> measured = e.at({0.0});
  std::reverse(measured.begin(), measured.end());
  const auto p = fit_parameters(e, measured, {.damping_prior_sd = 100});
  EXPECT_EQ(p[1].value, 0);
  EXPECT_EQ(p[1].low, 0);
  EXPECT_TRUE(p[1].at_edge);
}

// A narrow prior holds the share at 1, a wide one lets it go; between them it lies between.
TEST(PatternShare, PriorPullsTowardsTheModel) {
  const LightEmulator e = beer_emulator(6);
  std::vector<double> measured = e.at({0.0});
  const double noise[] = {0.1, -0.1, -0.05, 0.1, -0.1, 0.05};
  for (std::size_t s = 0; s < 6; ++s) measured[s] = 0.2 + 0.3 * (measured[s] - 0.2) + noise[s];
  double last = 1.0001;
  for (const double sd : {0.01, 0.3, 1.0, 30.0}) {
    const double share = fit_parameters(e, measured, {.damping_prior_sd = sd})[1].value;
    EXPECT_LT(share, last) << sd;
    last = share;
  }
  EXPECT_NEAR(fit_parameters(e, measured, {.damping_prior_sd = 0.01})[1].value, 1, 0.02);
}

// Halves of four cannot fit four parameters or more; of two, not two.
TEST(SplitHalf, DoesNotFitOnFewerSensorsThanParameters) {
  const LightEmulator e = beer_emulator(4);
  EXPECT_EQ(split_half(e, e.at({0.0})).splits, 0u);
  EXPECT_EQ(split_half(e, e.at({0.0}), {.damping = false}).splits, 6u);
}

// Trees in rows under a periodic sky; small enough for a second.
ForestSpec known_stand(double leaf_area_factor) {
  ForestSpec spec;
  for (int i = 0; i < 9; ++i) {
    InventoryTree tree;
    tree.id = {static_cast<std::uint32_t>(i + 1)};
    tree.species = "beech";
    tree.x_m = 3 + 6 * (i % 3), tree.y_m = 3 + 6 * (i / 3);
    tree.dbh_cm = 20 + i;
    spec.inventory.push_back(tree);
  }
  spec.trees = TreeSource::kCrown;
  spec.leaf_area = LeafAreaSource::kAllometry;
  spec.elements_per_tree = 400;
  spec.leaf_area_factor = leaf_area_factor;
  spec.period = Period{{0, 0}, {18, 18}};
  return spec;
}

StandStudySpec known_study() {
  const auto table = test::scratch_dir() / "radiation.csv";
  std::ofstream(table) << "month,global_horizontal_mj_m2,diffuse_fraction\n6,560,0.5\n";
  StandStudySpec spec;
  spec.place = {50, 5};
  spec.period = parse_period("2020-06-01T00:00+01:00", "2020-07-01T00:00+01:00", "stand_light");
  spec.radiation = table;
  spec.optics = {{"PAR"}, {0.1}, {}};
  spec.patch_deg = 15;
  for (int i = 0; i < 6; ++i) {
    SensorRow row;
    row.sensor.position_m = {1.0 + 3 * i, 17.0 - 2.5 * i};
    spec.sensors.push_back(row);
  }
  return spec;
}

SpeciesLibrary library() { return SpeciesLibrary::load(test::source_dir() / "configs/species"); }

// Measured: light of the same stand with half as much leaf area again, grown with another seed.
TEST(Calibrate, FindsTheLeafAreaOfAKnownStand) {
  StandStudySpec study = known_study();
  ForestSpec truth = known_stand(1.5);
  truth.seed = 99;
  const ExpectedLight light = expected_light(truth, library(), study, 3, {});
  for (std::size_t s = 0; s < study.sensors.size(); ++s) study.sensors[s].pacl = light.pacl[s];
  study.sensors.back().pacl.reset();
  CalibrationOptions options;
  options.realisations = 3;
  const Calibration c = calibrate(known_stand(1), library(), study, options, {});
  EXPECT_LE(c.parameters[0].low, 1.5);
  EXPECT_GE(c.parameters[0].high, 1.5);
  EXPECT_NEAR(c.parameters[0].value, 1.5, 0.15);  // three seeds on each side leave about 0.01 in each pacl
  EXPECT_LT(c.fit.rmse, c.fit_before->rmse);
  EXPECT_EQ(c.runs, 21);
  ASSERT_EQ(c.told.size(), study.sensors.size());  // the last one was kept back: told like the others
  EXPECT_EQ(c.sensors.size(), study.sensors.size() - 1);
  EXPECT_NEAR(c.told.back(), light.pacl.back(), 0.05);
  EXPECT_EQ(c.told[0], c.fitted[0]);
}

void expect_refused(const std::function<void()>& action, const std::string& problem) {
  try {
    action();
    ADD_FAILURE() << "accepted; expected: " << problem;
  } catch (const Error& error) {
    EXPECT_NE(error.problem().find(problem), std::string::npos) << error.what();
    EXPECT_FALSE(error.remedy().empty()) << error.what();
  }
}

TEST(Calibrate, RefusesWhatCannotBeFitted) {
  const SpeciesLibrary species = library();
  StandStudySpec study = known_study();
  CalibrationOptions options;
  const auto run = [&] { calibrate(known_stand(1), species, study, options, {}); };
  expect_refused(run, "carry no measurement");
  study.sensors[0].pacl = 0.2;
  expect_refused(run, "1 measured sensors cannot fit 2 parameters");
  options.damping = false;
  expect_refused(run, "1 measured sensors cannot fit 1 parameter");
  options.damping_prior_sd = 0;
  expect_refused(run, "is out of range");
  options = {};
  study.sensors[1].pacl = 1.2;
  expect_refused(run, "no share of light");
  study.sensors[1].pacl = study.sensors[2].pacl = 0.3;
  options.understorey = true;
  expect_refused(run, "the forest has none");
  options = {};
  options.least_factor = 5;
  expect_refused(run, "has no range");
  options = {};
  options.realisations = 0;
  expect_refused(run, "are 0");
}

// Cloture20 with natural crowns, nothing fitted to its sensors: the expected light of five realisations. The
// goal is 0.068; five seeds leave about 0.004 in the rmse and 0.03 in the correlation. Plain crowns: 0.084.
TEST(MeasuredStand, NaturalCrownsComeNearItsSensors) {
  const auto folder = test::shared_data("stands/cloture20");
  if (!folder) GTEST_SKIP() << "THE MEASURED STAND IS ABSENT: nothing was compared with measured light";
  ForestSpec stand;
  stand.inventory = read_inventory(*folder / "trees.csv");
  stand.plot = read_plot_polygon(*folder / "plot_polygon.csv");
  stand.surroundings = Surroundings::kPeriodic;
  apply(Realism::kNatural, stand);
  StandStudySpec spec = known_study();
  spec.patch_deg = 6;
  spec.sensor_sky_rays = 16;
  spec.sky = SkyModel::kPerez;
  spec.period = parse_period("2011-04-01T00:00+01:00", "2011-11-01T00:00+01:00", "stand_light");
  spec.place = {50.03617, 5.20634, 400};
  spec.radiation = *folder / "monthly_radiation.csv";
  spec.sensors = read_sensors(*folder / "sensors_measured.csv");
  const ExpectedLight light = expected_light(stand, library(), spec, 5, {});
  std::vector<double> measured;
  for (const SensorRow& row : spec.sensors) measured.push_back(*row.pacl);
  const SensorFit fit = sensor_fit(light.pacl, measured);
  std::printf(
      "measured stand, natural crowns: rmse %.4f, bias %+.4f, correlation %.3f, leaf area index %.2f\n",
      fit.rmse, fit.bias, fit.correlation, light.leaf_area_index);
  EXPECT_LT(fit.rmse, 0.068);
  EXPECT_LT(std::fabs(fit.bias), 0.02);
  EXPECT_GT(fit.correlation, 0.55);
}

}  // namespace
}  // namespace sunfleck
