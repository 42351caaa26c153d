// What is wrong in a radiation table is said at its row and column, with what would be right.
#include <gtest/gtest.h>

#include <functional>

#include "lighting/sky/radiation_series.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

constexpr Place kForest{50.0, 5.2};

TimeSpan period(const std::string& from, const std::string& to) { return parse_period(from, to, "period"); }

const std::string kMonths =
    "month,global_horizontal_mj_m2,diffuse_fraction\n5,528,0.53\n6,578,0.53\n7,591,0.52\n8,487,0.54\n";

TEST(RadiationTable, EveryMistakeIsSaidAtItsPlace) {
  struct Bad {
    std::string csv, where, problem;
  };
  const std::string m = "month,global_horizontal_mj_m2";
  const std::vector<Bad> table = {
      {"global_horizontal_mj_m2\n5\n", "t", "does not say when"},
      {"month,date,global_horizontal_mj_m2\n5,2024-05-01,5\n", "t", "twice"},
      {"month\n5\n", "t, column global_horizontal_<unit>", "missing"},
      {"month,global_horizontal_cal_cm2\n5,3\n", "t, column global_horizontal_<unit>", "missing"},
      {m + "," + "month\n5,3,5\n", "t:1", "two columns month"},
      {m + ",global_horizontal_j_m2\n5,3,3\n", "t, column global_horizontal_j_m2", "as well"},
      {m + "\n5,x\n", "t:2, column global_horizontal_mj_m2", "not a number"},
      {m + "\n5,\n", "t:2, column global_horizontal_mj_m2", "not a number"},
      {m + "\n5,nan\n", "t:2, column global_horizontal_mj_m2", "not a number"},
      {m + "\n5,3\n6,-3\n", "t:3, column global_horizontal_mj_m2", "out of range"},
      {m + "\n13,3\n", "t:2, column month", "out of range"},
      {m + "\n5.5,3\n", "t:2, column month", "no month"},
      {m + "\n5,3\n5,4\n", "t:3, column global_horizontal_mj_m2", "two rows"},
      {m + ",diffuse_fraction\n5,3,53\n", "t:2, column diffuse_fraction", "out of range"},
      {m + ",diffuse_horizontal_mj_m2\n5,3,4\n", "t:2, column diffuse_horizontal_mj_m2",
       "more than the global"},
      {m + ",diffuse_horizontal_w_m2\n5,3,4\n", "t:2, column diffuse_horizontal_w_m2", "kind of unit"},
      {m + ",diffuse_fraction,diffuse_horizontal_mj_m2\n5,3,1,3\n", "t, column diffuse_fraction", "as well"},
      {m + "\n", "t", "no rows"},
      {"date,global_horizontal_mj_m2\n2024-02-30,3\n", "t:2, column date", "not a date"},
      {"time,global_horizontal_w_m2\n2024-02-20T10:00,3\n", "t:2, column time", "no time zone"},
      {"time,global_horizontal_w_m2\n2024-02-20T10:00Z,3\n2024-02-21T10:00Z,3\n",
       "t:2, column global_horizontal_w_m2", "minutes apart"},
  };
  for (const Bad& bad : table) {
    try {
      parse_radiation(bad.csv, "t");
      ADD_FAILURE() << bad.csv;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput);
      EXPECT_EQ(error.where(), bad.where) << bad.csv;
      EXPECT_NE(error.problem().find(bad.problem), std::string::npos) << error.problem();
      EXPECT_FALSE(error.remedy().empty());
    }
  }
  try {
    read_radiation("/nowhere/radiation.csv");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kNotFound);
  }
}

void expect_error(const std::function<void()>& work, const std::string& where, const std::string& problem,
                  const std::string& remedy) {
  try {
    work();
    ADD_FAILURE() << problem;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput);
    EXPECT_EQ(error.where(), where);
    EXPECT_NE(error.problem().find(problem), std::string::npos) << error.problem();
    EXPECT_NE(error.remedy().find(remedy), std::string::npos) << error.remedy();
  }
}

TEST(RadiationSeries, WhatCannotBeIsRefusedWithTheUnitThatWouldFit) {
  const TimeSpan june = period("2011-06-01T00:00+01:00", "2011-07-01T00:00+01:00");
  const auto monthly = [&](const std::string& column, const std::string& value) {
    return [=] {
      radiation_series(kForest, june, parse_radiation("month," + column + "\n6," + value + "\n", "t"));
    };
  };
  const std::string mj = "global_horizontal_mj_m2", at = "t:2, column global_horizontal_mj_m2";
  expect_error(monthly(mj, "578e6"), at, "times what arrives outside", "fit as J m-2");
  expect_error(monthly(mj, "57800"), at, "times what arrives outside", "fit as J cm-2");
  expect_error(monthly(mj, "160556"), at, "times what arrives outside", "fit as Wh m-2");
  expect_error(monthly("global_horizontal_j_m2", "578"), "t, column global_horizontal_j_m2",
               "darker than any climate", "fit as MJ m-2");
  expect_error(monthly("global_horizontal_w_m2", "578000"), "t:2, column global_horizontal_w_m2",
               "times what arrives", "check the unit");
  EXPECT_NO_THROW(monthly("global_horizontal_kwh_m2", "160.6")());
  EXPECT_NO_THROW(monthly("global_horizontal_w_m2", "223")());
  // Kilowatt hours under the head of megajoules, over a year.
  std::string year = "month," + mj + "\n";
  const double kwh[] = {23.5, 38.8, 81, 127, 147, 160, 164, 135, 101, 58, 28, 19};
  for (int month = 1; month <= 12; ++month)
    year += std::to_string(month) + "," + std::to_string(kwh[month - 1]) + "\n";
  expect_error(
      [&] {
        radiation_series(kForest, period("2011-01-01T00:00Z", "2012-01-01T00:00Z"),
                         parse_radiation(year, "t"));
      },
      "t, column " + mj, "darker than any climate", "kWh m-2");
  // Noon at midnight: a wrong time zone.
  expect_error(
      [&] {
        radiation_series(kForest, period("2011-06-21T00:00Z", "2011-06-21T01:00Z"),
                         parse_radiation("time,global_horizontal_w_m2\n2011-06-21T00:00Z,800\n", "t"));
      },
      "t:2, column global_horizontal_w_m2", "while the sun is down", "time zone");
}

TEST(RadiationSeries, DatesOutsideTheTableAreSaid) {
  const auto run = [&](const std::string& csv, const char* from, const char* to) {
    return [=] { radiation_series(kForest, period(from, to), parse_radiation(csv, "t")); };
  };
  expect_error(run(kMonths, "2011-08-15T00:00Z", "2011-09-02T00:00Z"), "t", "no row for 2011-09",
               "period within");
  expect_error(
      run("year,month,global_horizontal_mj_m2\n2010,5,500\n", "2011-05-01T00:00Z", "2011-05-02T00:00Z"), "t",
      "no row for 2011-05", "period within");
  expect_error(run("date,global_horizontal_mj_m2\n2011-05-01,15\n2011-05-03,15\n", "2011-05-01T00:00Z",
                   "2011-05-04T00:00Z"),
               "t", "no row for 2011-05-02", "period within");
  const std::string hours =
      "time,global_horizontal_w_m2\n2011-05-01T10:00Z,500\n2011-05-01T11:00Z,500\n2011-05-01T13:00Z,500\n";
  expect_error(run(hours, "2011-05-01T10:00Z", "2011-05-01T14:00Z"), "t", "no row for 2011-05-01T12:00Z",
               "period within");
  expect_error(run(hours, "2011-05-01T09:00Z", "2011-05-01T11:00Z"), "t", "no row for 2011-05-01T09:00Z",
               "period within");
  EXPECT_NO_THROW(run(hours, "2011-05-01T10:30Z", "2011-05-01T12:00Z")());
}

TEST(TimeSpan, IsRefusedByItsEnd) {
  const auto refused = [](const char* from, const char* to, const char* where, const char* problem) {
    expect_error([=] { parse_period(from, to, "light.period"); }, where, problem, "");
  };
  refused("2011-05-01T00:00", "2011-06-01T00:00Z", "light.period.from", "no time zone");
  refused("2011-05-01T00:00Z", "2011-06-01T00:00", "light.period.to", "no time zone");
  refused("2011-05-01T00:00Z", "2011-05-01T00:00Z", "light.period.to", "not after");
  refused("2011-05-01T00:00Z", "2031-06-01T00:00Z", "light.period.to", "20 years");
}

}  // namespace
}  // namespace sunfleck
