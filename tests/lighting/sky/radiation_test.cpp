// Radiation tables, their split and spread: energy is kept, correlations have their published values, and
// what is wrong in a table is said at its row and column.
#include <gtest/gtest.h>

#include <cmath>

#include "lighting/sky/par.h"
#include "lighting/sky/radiation_series.h"
#include "lighting/sky/radiation_split.h"
#include "lighting/sky/sun_day.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

constexpr Place kForest{50.0, 5.2};

TimeSpan period(const std::string& from, const std::string& to) { return parse_period(from, to, "period"); }

const std::string kMonths =
    "month,global_horizontal_mj_m2,diffuse_fraction\n5,528,0.53\n6,578,0.53\n7,591,0.52\n8,487,0.54\n";

double energy_between(const RadiationSeries& series, double begin_s, double end_s) {
  double sum = 0;
  for (const SunStep& step : series.steps)
    if (step.middle_s >= begin_s && step.middle_s < end_s)
      sum += step.beam_normal_j_m2 * std::max(0.0, step.to_sun.z) + step.diffuse_horizontal_j_m2;
  return sum;
}

// Published values: [Erbs82] at the joints of its pieces, and by hand inside: k = 0.5: 0.9511 - 0.0802
// + 1.097 - 2.07975 + 0.771 = 0.65915.
TEST(RadiationSplit, CorrelationsAreThosePublished) {
  EXPECT_NEAR(hourly_diffuse_fraction(0.1), 0.991, 1e-12);
  EXPECT_NEAR(hourly_diffuse_fraction(0.5), 0.65915, 1e-9);
  EXPECT_NEAR(hourly_diffuse_fraction(0.9), 0.165, 1e-12);
  EXPECT_NEAR(hourly_diffuse_fraction(0.22), hourly_diffuse_fraction(0.2200001), 2e-3);
  EXPECT_NEAR(hourly_diffuse_fraction(0.80), 0.165, 2e-3);
  EXPECT_EQ(hourly_diffuse_fraction(-1), 1.0);
  // Summer day, k = 0.5: 1 + 0.1416 - 0.638925 + 0.1056 = 0.608275; winter: 1 - 0.13635 + 0.612375 - 1.493925
  // + 0.58674375 = 0.56884375.
  EXPECT_NEAR(daily_diffuse_fraction(0.5, 1.7), 0.608275, 1e-9);
  EXPECT_NEAR(daily_diffuse_fraction(0.5, 1.2), 0.56884375, 1e-9);
  // Month, k = 0.5: 1.391 - 1.78 + 1.04725 - 0.267125 = 0.391125 (winter), 1.311 - 1.511 + 0.85675 - 0.227625
  // = 0.429125.
  EXPECT_NEAR(monthly_diffuse_fraction(0.5, 1.2), 0.391125, 1e-9);
  EXPECT_NEAR(monthly_diffuse_fraction(0.5, 1.7), 0.429125, 1e-9);
  EXPECT_EQ(monthly_diffuse_fraction(0.1, 1.7), monthly_diffuse_fraction(0.3, 1.7));
  EXPECT_NEAR(sunset_hour_angle_rad(0.0, 0.4), 0.5 * kPi, 1e-12);
  EXPECT_EQ(sunset_hour_angle_rad(1.5, -0.4), 0.0);
  EXPECT_NEAR(sunset_hour_angle_rad(1.5, 0.4), kPi, 1e-12);
  EXPECT_TRUE(std::isfinite(sunset_hour_angle_rad(0.5 * kPi, 0.0)));
}

// Collares-Pereira and Rabl's factors are made so that hourly shares of a day sum to 1: with our numbers,
// over a 12-hour day, pi/24 * sum over hours of (a + b cos w)(cos w - cos ws) / (sin ws - ws cos ws) = 1
// within 1 %.
TEST(RadiationSplit, HourlySharesOfGlobalSumToOne) {
  for (const double sunset : {1.0, 1.3, 0.5 * kPi, 1.9, 2.2}) {
    double sum = 0;
    constexpr int n = 2000;
    for (int i = 0; i < n; ++i) {
      const double w = sunset * (2 * (i + 0.5) / n - 1);
      sum += hourly_global_shape(w, sunset) * (std::cos(w) - std::cos(sunset)) * (2 * sunset / n) / 2;
    }
    EXPECT_NEAR(sum / (std::sin(sunset) - sunset * std::cos(sunset)), 1.0, 0.015) << sunset;
  }
}

TEST(RadiationSeries, KeepsTheEnergyOfEveryMonth) {
  const RadiationTable table = parse_radiation(kMonths, "months.csv");
  const RadiationSeries s =
      radiation_series(kForest, period("2011-05-01T00:00+01:00", "2011-09-01T00:00+01:00"), table);
  const double total = (528 + 578 + 591 + 487) * 1e6;
  EXPECT_NEAR(s.direct_horizontal_j_m2 + s.diffuse_horizontal_j_m2, total, 1e-12 * total);
  EXPECT_EQ(s.moved_to_diffuse_j_m2, 0.0);
  EXPECT_EQ(s.energy_split_by_correlation_j_m2, 0.0);
  const double diffuse = (528 * .53 + 578 * .53 + 591 * .52 + 487 * .54) * 1e6;
  EXPECT_NEAR(s.diffuse_horizontal_j_m2, diffuse, 1e-12 * diffuse);
  const double june = parse_zoned_time("2011-06-01T00:00+01:00", "t").utc_s;
  EXPECT_NEAR(energy_between(s, june, june + 30 * 86400.0), 578e6, 1e-9 * 578e6);
  for (const SunStep& step : s.steps) {
    ASSERT_TRUE(std::isfinite(step.beam_normal_j_m2) && step.beam_normal_j_m2 >= 0.0);
    ASSERT_GE(step.diffuse_horizontal_j_m2, 0.0);
    ASSERT_LT(step.beam_normal_j_m2, 1420.0 * step.duration_s);
  }
}

// A part of a month gets its part by extraterrestrial radiation; halves add up to the whole, also cut within
// a step.
TEST(RadiationSeries, PartsOfAPeriodAddUp) {
  const RadiationTable table = parse_radiation(kMonths, "months.csv");
  const auto energy = [&](const char* from, const char* to) {
    const RadiationSeries s = radiation_series(kForest, period(from, to), table);
    return s.direct_horizontal_j_m2 + s.diffuse_horizontal_j_m2;
  };
  const double whole = energy("2011-06-01T00:00+01:00", "2011-07-01T00:00+01:00");
  const double parts = energy("2011-06-01T00:00+01:00", "2011-06-17T10:07:30+01:00") +
                       energy("2011-06-17T10:07:30+01:00", "2011-07-01T00:00+01:00");
  EXPECT_NEAR(whole, 578e6, 1.0);
  EXPECT_NEAR(parts, whole, 1e-9 * whole);
  EXPECT_GT(energy("2011-06-17T12:00+01:00", "2011-06-17T13:00+01:00"), 1e6);
  EXPECT_EQ(energy("2011-06-17T00:00+01:00", "2011-06-17T01:00+01:00"), 0.0);
}

TEST(RadiationSeries, KeepsTheEnergyOfDaysAndHoursWithAndWithoutAShare) {
  const RadiationTable days = parse_radiation(
      "date;global_horizontal_wh_m2\n2024-06-21;6000\n2024-06-22;1200\n2024-06-23;7900\n", "days.csv");
  const RadiationSeries d =
      radiation_series(kForest, period("2024-06-21T00:00+01:00", "2024-06-24T00:00+01:00"), days);
  const double begin = d.period.begin_s;
  EXPECT_NEAR(energy_between(d, begin, begin + 86400), 6000 * 3600.0, 1e-3);
  EXPECT_NEAR(energy_between(d, begin + 86400, begin + 2 * 86400), 1200 * 3600.0, 1e-3);
  EXPECT_NEAR(d.energy_split_by_correlation_j_m2, 15100 * 3600.0, 1e-3);
  // A dark day is diffuse, a bright one mostly direct.
  double dark_direct = 0, bright_direct = 0;
  for (const SunStep& s : d.steps) {
    if (s.middle_s >= begin + 86400 && s.middle_s < begin + 2 * 86400)
      dark_direct += s.beam_normal_j_m2 * s.to_sun.z;
    if (s.middle_s >= begin + 2 * 86400) bright_direct += s.beam_normal_j_m2 * s.to_sun.z;
  }
  EXPECT_LT(dark_direct, 0.05 * 1200 * 3600.0);
  EXPECT_GT(bright_direct, 0.6 * 7900 * 3600.0);

  std::string csv = "time,global_horizontal_w_m2,diffuse_horizontal_w_m2\n";
  const double watts[] = {600, 700, 300, 150};
  for (int h = 0; h < 4; ++h)
    csv += "2024-06-21T" + std::to_string(10 + h) + ":00+01:00," + std::to_string(watts[h]) + ",150\n";
  const RadiationSeries t = radiation_series(
      kForest, period("2024-06-21T10:00+01:00", "2024-06-21T14:00+01:00"), parse_radiation(csv, "hours.csv"));
  for (int h = 0; h < 4; ++h)
    EXPECT_NEAR(energy_between(t, t.period.begin_s + 3600 * h, t.period.begin_s + 3600 * (h + 1)),
                3600 * watts[h], 1e-4);
  EXPECT_NEAR(t.diffuse_horizontal_j_m2, 4 * 3600 * 150.0, 1e-4);
}

// An hour at sunrise with much radiation: the beam is held to what is measured anywhere, the rest is sky
// light.
TEST(RadiationSeries, LowSunDoesNotMakeABeamWithoutEnd) {
  const RadiationTable table =
      parse_radiation("time,global_horizontal_w_m2,diffuse_fraction\n2024-06-21T04:00Z,150,0.05\n", "h.csv");
  const RadiationSeries s =
      radiation_series(kForest, period("2024-06-21T04:00Z", "2024-06-21T05:00Z"), table);
  EXPECT_GT(s.moved_to_diffuse_j_m2, 0.0);
  EXPECT_NEAR(s.direct_horizontal_j_m2 + s.diffuse_horizontal_j_m2, 150 * 3600.0, 1e-6);
  for (const SunStep& step : s.steps)
    EXPECT_LE(step.beam_normal_j_m2 / step.duration_s,
              most_beam_normal_w_m2(step.extraterrestrial_normal_w_m2, step.to_sun.z) * (1 + 1e-12));
}

TEST(RadiationSeries, PolarNightIsZeroAndMidsummerRunsRoundTheClock) {
  const RadiationTable table =
      parse_radiation("month,global_horizontal_mj_m2\n6,600\n12,0\n1,0.1\n", "arctic.csv");
  const Place arctic{78.2, 15.6};
  const RadiationSeries night =
      radiation_series(arctic, period("2023-12-01T00:00+01:00", "2024-01-01T00:00+01:00"), table);
  EXPECT_TRUE(night.steps.empty());
  EXPECT_EQ(night.direct_horizontal_j_m2 + night.diffuse_horizontal_j_m2, 0.0);
  // Twilight of January: diffuse, all of it.
  const RadiationSeries twilight =
      radiation_series(arctic, period("2024-01-01T00:00+01:00", "2024-02-01T00:00+01:00"), table);
  EXPECT_EQ(twilight.direct_horizontal_j_m2, 0.0);
  EXPECT_NEAR(twilight.diffuse_horizontal_j_m2, 0.1e6, 1e-6);
  const RadiationSeries summer =
      radiation_series(arctic, period("2024-06-01T00:00+01:00", "2024-07-01T00:00+01:00"), table);
  EXPECT_EQ(summer.steps.size(), 30u * 144u);
  EXPECT_NEAR(summer.direct_horizontal_j_m2 + summer.diffuse_horizontal_j_m2, 600e6, 1e-3);
}

TEST(RadiationTable, ReadsTheMeasuredStandsAsTheyAre) {
  for (const char* stand : {"cloture20", "bechefa"}) {
    const auto path = test::shared_data(std::string("stands/") + stand + "/monthly_radiation.csv");
    if (!path) GTEST_SKIP() << "the measured stands are not here";
    const RadiationTable table = read_radiation(*path);
    ASSERT_EQ(table.rows.size(), 12u);
    double total = 0;
    for (const RadiationRow& row : table.rows) total += row.global;
    const RadiationSeries s =
        radiation_series({50.04, 5.2}, period("2011-01-01T00:00+01:00", "2012-01-01T00:00+01:00"), table);
    EXPECT_NEAR(s.direct_horizontal_j_m2 + s.diffuse_horizontal_j_m2, total, 1e-9 * total);
    EXPECT_EQ(s.moved_to_diffuse_j_m2, 0.0);
  }
}

TEST(Par, FactorsAreStated) {
  const ParFactors par;
  EXPECT_NEAR(par.par_j_m2(1e6), 0.47e6, 1e-6);
  EXPECT_NEAR(par.par_umol_m2(1.0), 0.47 * 4.57, 1e-12);
}

}  // namespace
}  // namespace sunfleck
