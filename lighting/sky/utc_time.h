// Moments: text with a time zone in, seconds since 2000-01-01T00:00 UTC inside. Days have 86,400 seconds;
// leap seconds and UT1 - UTC (under 0.9 s, 0.004 degrees of the sun's way) are left out.
#pragma once

#include <string>

namespace sunfleck {

// Hour and minute may run over a day's end after an offset was taken off.
struct UtcTime {
  int year = 2000, month = 1, day = 1, hour = 0, minute = 0;
  double second = 0;
};

// A moment and the offset of the clock it was read from.
struct ZonedTime {
  double utc_s = 0;        // seconds since 2000-01-01T00:00 UTC
  int offset_minutes = 0;  // local clock minus UTC, [-14 h, 14 h]
};

// A day of the calendar; days are counted from 2000-01-01, which is 0.
struct CivilDate {
  int year = 2000, month = 1, day = 1;
};
int day_number(const CivilDate& date);
CivilDate date_of_day(int day_number);
bool is_date(const CivilDate& date);  // a day there is, between 1900 and 2100

double seconds_since_2000(const UtcTime& time);
// Day of the local clock at a moment, and the moment that day begins.
int local_day(double utc_s, int offset_minutes);
double day_begin_s(int day_number, int offset_minutes);

// ISO 8601 with a time zone: "2024-06-21T11:30:00Z", seconds may be left out, the zone is Z or an offset
// (+02:00, -0730, +02). Throws Error(kInvalidInput) at `where`: one message for a missing time zone, one for
// anything else that is no time between 1900 and 2100.
UtcTime parse_utc_time(const std::string& text, const std::string& where);
ZonedTime parse_zoned_time(const std::string& text, const std::string& where);
// "2024-06-21". Throws at `where`.
CivilDate parse_date(const std::string& text, const std::string& where);

std::string date_text(const CivilDate& date);                   // "2024-06-21"
std::string offset_text(int offset_minutes);                    // "Z", "+01:00"
std::string local_time_text(double utc_s, int offset_minutes);  // "2024-06-21T13:30+01:00", to the minute
// "2024-06-21T13:30:00.25+01:00": parse_zoned_time() gives the same number again.
std::string exact_time_text(double utc_s, int offset_minutes);

}  // namespace sunfleck
