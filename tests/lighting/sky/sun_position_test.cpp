// The sun against two independent ephemerides recorded in golden/sun_positions.json (which says how), against
// what geometry demands, and days without sunrise or sunset.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <nlohmann/json.hpp>
#include <thread>

#include "lighting/sky/sun_day.h"
#include "sim/base/error.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

Place recorded_place(const nlohmann::json& row) {
  return {row["latitude_deg"], row["longitude_deg"], row["elevation_m"], row["pressure_hpa"],
          row["temperature_c"]};
}

double angle_deg(double azimuth_a, double zenith_a, double azimuth_b, double zenith_b) {
  const auto direction = [](double azimuth, double zenith) {
    return direction_from_azimuth_zenith(radians_from_degrees(azimuth), radians_from_degrees(zenith));
  };
  return degrees_from_radians(glm::length(direction(azimuth_a, zenith_a) - direction(azimuth_b, zenith_b)));
}

// Measured: 0.00013 degrees against SPA, 0.00034 against ERFA, which differ by as much among themselves. The
// goal is 0.01; 0.0005 is what the header promises.
TEST(SunPosition, AgreesWithTwoEphemeridesFrom1950To2050) {
  const nlohmann::json file = test::golden("sun_positions.json");
  ASSERT_EQ(file["positions"].size(), 240u);
  double worst_spa = 0, worst_erfa = 0, worst_refracted = 0;
  for (const auto& row : file["positions"]) {
    const SunPosition sun = sun_position(recorded_place(row), parse_utc_time(row["time"], "test"));
    const double azimuth = degrees_from_radians(sun.azimuth_rad);
    const double zenith = degrees_from_radians(sun.true_zenith_rad);
    worst_spa =
        std::max(worst_spa, angle_deg(azimuth, zenith, row["spa_azimuth_deg"], row["spa_true_zenith_deg"]));
    worst_erfa = std::max(worst_erfa,
                          angle_deg(azimuth, zenith, row["erfa_azimuth_deg"], row["erfa_true_zenith_deg"]));
    worst_refracted = std::max(worst_refracted, std::abs(degrees_from_radians(sun.zenith_rad) -
                                                         row["spa_apparent_zenith_deg"].get<double>()));
  }
  EXPECT_LT(worst_spa, 5e-4);
  EXPECT_LT(worst_erfa, 5e-4);
  EXPECT_LT(worst_refracted, 5e-4);
  RecordProperty("worst_spa_deg", std::to_string(worst_spa));
  RecordProperty("worst_erfa_deg", std::to_string(worst_erfa));
  RecordProperty("worst_refracted_deg", std::to_string(worst_refracted));
}

TEST(SunPosition, TrackFollowsTheEphemerisBetweenItsNodes) {
  const double begin = seconds_since_2000({2023, 12, 20}), end = seconds_since_2000({2025, 1, 10});
  const SunTrack track(begin, end);
  const Place place{50.04, 5.2};
  double worst = 0;
  for (double t = begin; t <= end; t += 40009.0) {
    const SunPosition a = track.at(place, t), b = sun_position(place, t);
    worst = std::max(worst, degrees_from_radians(glm::length(a.to_sun() - b.to_sun())));
    EXPECT_NEAR(a.distance_au, b.distance_au, 1e-7);
  }
  EXPECT_LT(worst, 1e-5);
}

// Times of the records are whole seconds, and SPA's own rise and set leave out parallax (0.0024 degrees) and
// interpolate over the day: a second or two where the sun rises steeply, more near the polar circle, where it
// grazes the horizon. The records are of UTC days, but carry the date nearest to noon: times of day are
// compared.
TEST(SunDay, RisesAndSetsWithTheRecords) {
  const nlohmann::json file = test::golden("sun_positions.json");
  double worst_s = 0;
  int polar = 0;
  for (const auto& row : file["days"]) {
    const Place place{row["latitude_deg"], row["longitude_deg"]};
    if (row["sunrise"].is_null()) {
      ++polar;
      const double length = sun_day(place, parse_date(row["date"], "test"), 0).day_length_s;
      EXPECT_TRUE(length == 0.0 || std::abs(length - 86400.0) < 1e-6) << row;
      continue;
    }
    const SunDay day = sun_day(place, parse_date(row["date"], "test"), 0);
    ASSERT_TRUE(day.sunrise_utc_s && day.sunset_utc_s) << row;
    for (const char* event : {"sunrise", "sunset"}) {
      const double found = std::string(event) == "sunrise" ? *day.sunrise_utc_s : *day.sunset_utc_s;
      const double recorded = parse_zoned_time(row[event], "test").utc_s;
      worst_s = std::max(worst_s, std::abs(std::remainder(recorded - found, 86400.0)));
    }
  }
  EXPECT_GE(polar, 8);
  EXPECT_LT(worst_s, 12.0);
  RecordProperty("worst_s", std::to_string(worst_s));
}

TEST(SunDay, RadiationOutsideTheAtmosphereIsThatOfTheRecords) {
  const nlohmann::json file = test::golden("sun_positions.json");
  for (const auto& row : file["daily"]) {
    const Place place{row["latitude_deg"], row["longitude_deg"]};
    const SunDay day = sun_day(place, parse_date(row["date"], "test"), row["offset_minutes"].get<int>());
    const double expected = row["extraterrestrial_mj_m2"].get<double>();
    EXPECT_NEAR(day.extraterrestrial_j_m2 * 1e-6, expected, 2e-4 * expected + 1e-3) << row;
  }
}

TEST(SunDay, PolarNightIsZeroAndMidsummerDoesNotSet) {
  for (const double latitude : {69.65, 80.0, 89.99, 90.0, -78.0, -90.0}) {
    const CivilDate winter{2024, latitude > 0 ? 12 : 6, 21}, summer{2024, latitude > 0 ? 6 : 12, 21};
    const SunDay night = sun_day({latitude, 20}, winter, 60);
    EXPECT_FALSE(night.sunrise_utc_s || night.sunset_utc_s) << latitude;
    EXPECT_EQ(night.day_length_s, 0.0);
    EXPECT_EQ(night.extraterrestrial_j_m2, 0.0);
    const SunDay light = sun_day({latitude, 20}, summer, 60);
    EXPECT_FALSE(light.sunrise_utc_s || light.sunset_utc_s) << latitude;
    EXPECT_NEAR(light.day_length_s, 86400.0, 1e-6);
    EXPECT_GT(light.extraterrestrial_j_m2, 30e6);
  }
}

// A day whose light lasts minutes: between the polar night and the first sunrise the length grows without
// jumps over the five minutes between samples.
TEST(SunDay, VeryShortDaysAreSeen) {
  const int first = day_number({2024, 1, 5});
  double before = 0;
  for (int day = first; day < first + 30; ++day) {
    const SunDay d = sun_day({69.65, 18.96}, date_of_day(day), 60);
    EXPECT_EQ(d.day_length_s > 0.0, d.sunrise_utc_s.has_value());
    EXPECT_GE(d.day_length_s, before);
    before = d.day_length_s;
  }
  EXPECT_GT(before, 3 * 3600.0);
}

TEST(Time, ReadsZonesAndRefusesTheirAbsenceByName) {
  const auto utc = [](const char* text) { return parse_zoned_time(text, "t").utc_s; };
  EXPECT_EQ(utc("2000-01-01T00:00Z"), 0.0);
  EXPECT_EQ(utc("2000-01-01T02:00+02:00"), 0.0);
  EXPECT_EQ(utc("1999-12-31T16:30:00-0730"), 0.0);
  EXPECT_EQ(utc("2000-01-01T01:00:00.5+01"), 0.5);
  EXPECT_EQ(utc("2024-02-29T24:00Z"), utc("2024-03-01T00:00Z"));
  EXPECT_EQ(parse_zoned_time("2024-06-21T00:00-03:30", "t").offset_minutes, -210);
  for (const char* text : {"2024-06-21T11:30", "2024-06-21T11:30:00"}) {
    try {
      parse_zoned_time(text, "light.sun.time");
      FAIL() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.where(), "light.sun.time");
      EXPECT_NE(error.problem().find("no time zone"), std::string::npos);
      EXPECT_NE(error.remedy().find(std::string(text) + "+01:00"), std::string::npos);
    }
  }
  for (const char* text :
       {"2024-02-30T00:00Z", "2023-02-29T00:00Z", "2024-06-21T11:60Z", "2024-06-21T24:01Z",
        "2024-06-21T11:30+15:00", "2024-06-21T11:30+1", "2024-06-21T11:30Zulu", "2024-06-21 11:30Z",
        "2024-06-21T11:30:xxZ", "2024-06-21T11:30+02:", "1899-06-21T11:30Z"}) {
    EXPECT_THROW(parse_zoned_time(text, "t"), Error) << text;
  }
}

TEST(Time, CalendarAndTextGoThereAndBack) {
  EXPECT_EQ(day_number({2000, 1, 1}), 0);
  EXPECT_EQ(day_number({2001, 1, 1}), 366);
  for (int day = -36000; day < 36000; day += 17) EXPECT_EQ(day_number(date_of_day(day)), day);
  EXPECT_EQ(local_day(-1.0, 0), -1);
  EXPECT_EQ(local_day(-1.0, 60), 0);
  EXPECT_EQ(local_time_text(parse_zoned_time("2024-06-21T23:30Z", "t").utc_s, 120), "2024-06-22T01:30+02:00");
  EXPECT_EQ(local_time_text(0, -210), "1999-12-31T20:30-03:30");
}

// The ephemeris library remembers its last answers: neither who asked before nor who asks beside may matter.
TEST(SunPosition, DoesNotDependOnOtherCalls) {
  const Place place{50, 5};
  const auto same = [](const SunPosition& a, const SunPosition& b) {
    return a.zenith_rad == b.zenith_rad && a.azimuth_rad == b.azimuth_rad &&
           a.declination_rad == b.declination_rad;
  };
  std::vector<double> times_s;
  std::vector<SunPosition> alone;
  for (int i = 0; i < 400; ++i) {
    times_s.push_back(6e8 + 1000.0 * i);  // within the 0.1 days that are remembered
    sun_position(place, 1e8);             // far from it
    alone.push_back(sun_position(place, times_s.back()));
  }
  std::atomic<int> others{0};
  const auto ask = [&](int begin, int step) {
    for (int round = 0; round < 6; ++round)
      for (int i = begin; i >= 0 && i < 400; i += step)
        if (!same(sun_position(place, times_s.at(static_cast<std::size_t>(i))),
                  alone.at(static_cast<std::size_t>(i))))
          ++others;
  };
  { std::jthread up(ask, 0, 1), down(ask, 399, -1), leaps(ask, 3, 7); }
  EXPECT_EQ(others, 0);
}

TEST(Place, IsRefusedByField) {
  try {
    check_place({91, 0}, "site");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), "site.latitude_deg");
  }
  EXPECT_THROW(check_place({std::nan(""), 0}, "site"), Error);
  EXPECT_THROW(check_place({0, 200}, "site"), Error);
  EXPECT_THROW(check_place({0, 0, 0, -5}, "site"), Error);
  EXPECT_NO_THROW(check_place({-90, 180, 100, 0}, "site"));
}

}  // namespace
}  // namespace sunfleck
