#include "lighting/sky/utc_time.h"

#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string_view>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

using std::chrono::days;
using std::chrono::sys_days;
using std::chrono::year_month_day;

constexpr sys_days kFirstDay{std::chrono::year{2000} / 1 / 1};
constexpr int kLargestOffsetMinutes = 14 * 60;

year_month_day calendar(const CivilDate& date) {
  return std::chrono::year{date.year} / std::chrono::month{static_cast<unsigned>(date.month)} /
         std::chrono::day{static_cast<unsigned>(date.day)};
}

// Takes `count` digits off the front of `rest`.
std::optional<int> take_digits(std::string_view& rest, std::size_t count) {
  int value = 0;
  if (rest.size() < count) return std::nullopt;
  for (std::size_t i = 0; i < count; ++i) {
    if (rest[i] < '0' || rest[i] > '9') return std::nullopt;
    value = 10 * value + (rest[i] - '0');
  }
  rest.remove_prefix(count);
  return value;
}

bool take(std::string_view& rest, char c) {
  if (rest.empty() || rest.front() != c) return false;
  rest.remove_prefix(1);
  return true;
}

std::optional<CivilDate> take_date(std::string_view& rest) {
  const auto year = take_digits(rest, 4);
  if (!year || !take(rest, '-')) return std::nullopt;
  const auto month = take_digits(rest, 2);
  if (!month || !take(rest, '-')) return std::nullopt;
  const auto day = take_digits(rest, 2);
  if (!day || !is_date({*year, *month, *day})) return std::nullopt;
  return CivilDate{*year, *month, *day};
}

// ":30" or ":30.25"; none means 0.
std::optional<double> take_seconds(std::string_view& rest) {
  if (!take(rest, ':')) return 0.0;
  double second = 0;
  if (rest.empty() || rest.front() < '0' || rest.front() > '9') return std::nullopt;
  const auto [end, code] =
      std::from_chars(rest.data(), rest.data() + rest.size(), second, std::chars_format::fixed);
  if (code != std::errc() || !(second < 61.0)) return std::nullopt;
  rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
  return second;
}

std::optional<UtcTime> take_clock_time(std::string_view& rest) {
  const auto date = take_date(rest);
  if (!date || !take(rest, 'T')) return std::nullopt;
  const auto hour = take_digits(rest, 2);
  if (!hour || !take(rest, ':')) return std::nullopt;
  const auto minute = take_digits(rest, 2);
  if (!minute || *hour > 24 || *minute > 59) return std::nullopt;
  const auto second = take_seconds(rest);
  if (!second || (*hour == 24 && (*minute > 0 || *second > 0.0))) return std::nullopt;
  return UtcTime{date->year, date->month, date->day, *hour, *minute, *second};
}

// All of `rest` as Z or an offset in minutes.
std::optional<int> take_zone(std::string_view rest) {
  if (take(rest, 'Z')) return rest.empty() ? std::optional<int>(0) : std::nullopt;
  const int sign = !rest.empty() && rest.front() == '-' ? -1 : 1;
  if (!take(rest, '+') && !take(rest, '-')) return std::nullopt;
  const auto hours = take_digits(rest, 2);
  if (!hours) return std::nullopt;
  const bool colon = take(rest, ':');
  const auto minutes = rest.empty() && !colon ? std::optional<int>(0) : take_digits(rest, 2);
  if (!minutes || !rest.empty() || *minutes > 59) return std::nullopt;
  const int offset = 60 * *hours + *minutes;
  return offset <= kLargestOffsetMinutes ? std::optional<int>(sign * offset) : std::nullopt;
}

struct ClockTime {
  UtcTime clock;
  int offset_minutes;
};

ClockTime parse_clock_time(const std::string& text, const std::string& where) {
  std::string_view rest = text;
  const auto clock = take_clock_time(rest);
  if (clock && rest.empty())
    throw_invalid(where, "'" + text + "' has no time zone",
                  "add Z for UTC or the offset of the clock, for example " + text + "+01:00");
  const auto offset = clock ? take_zone(rest) : std::nullopt;
  if (!offset)
    throw_invalid(where, "'" + text + "' is not a time between 1900 and 2100 with its time zone",
                  "for example 2024-06-21T11:30:00Z or 2024-06-21T13:30:00+02:00");
  return {*clock, *offset};
}

}  // namespace

int day_number(const CivilDate& date) {
  return static_cast<int>((sys_days(calendar(date)) - kFirstDay).count());
}

CivilDate date_of_day(int day_number) {
  const year_month_day date(kFirstDay + days(day_number));
  return {static_cast<int>(date.year()), static_cast<int>(static_cast<unsigned>(date.month())),
          static_cast<int>(static_cast<unsigned>(date.day()))};
}

bool is_date(const CivilDate& date) {
  return date.year >= 1900 && date.year <= 2100 && date.month >= 1 && date.day >= 1 && calendar(date).ok();
}

double seconds_since_2000(const UtcTime& t) {
  return 86400.0 * day_number({t.year, t.month, t.day}) + 3600.0 * t.hour + 60.0 * t.minute + t.second;
}

int local_day(double utc_s, int offset_minutes) {
  return static_cast<int>(std::floor((utc_s + 60.0 * offset_minutes) / 86400.0));
}

double day_begin_s(int day_number, int offset_minutes) {
  return 86400.0 * day_number - 60.0 * offset_minutes;
}

UtcTime parse_utc_time(const std::string& text, const std::string& where) {
  ClockTime t = parse_clock_time(text, where);
  t.clock.hour -= t.offset_minutes / 60;
  t.clock.minute -= t.offset_minutes % 60;
  return t.clock;
}

ZonedTime parse_zoned_time(const std::string& text, const std::string& where) {
  const ClockTime t = parse_clock_time(text, where);
  return {seconds_since_2000(t.clock) - 60.0 * t.offset_minutes, t.offset_minutes};
}

CivilDate parse_date(const std::string& text, const std::string& where) {
  std::string_view rest = text;
  const auto date = take_date(rest);
  if (!date || !rest.empty())
    throw_invalid(where, "'" + text + "' is not a date between 1900 and 2100", "for example 2024-06-21");
  return *date;
}

std::string date_text(const CivilDate& date) {
  char text[32];
  std::snprintf(text, sizeof text, "%04d-%02d-%02d", date.year, date.month, date.day);
  return text;
}

std::string offset_text(int offset_minutes) {
  if (offset_minutes == 0) return "Z";
  const int size = std::abs(offset_minutes);
  char text[32];
  std::snprintf(text, sizeof text, "%c%02d:%02d", offset_minutes < 0 ? '-' : '+', size / 60, size % 60);
  return text;
}

std::string local_time_text(double utc_s, int offset_minutes) {
  const int day = local_day(utc_s, offset_minutes);
  const int minute = static_cast<int>(std::floor((utc_s - day_begin_s(day, offset_minutes)) / 60.0));
  char text[32];
  std::snprintf(text, sizeof text, "T%02d:%02d", minute / 60, minute % 60);
  return date_text(date_of_day(day)) + text + offset_text(offset_minutes);
}

std::string exact_time_text(double utc_s, int offset_minutes) {
  const int day = local_day(utc_s, offset_minutes);
  const double second_of_day = utc_s - day_begin_s(day, offset_minutes);
  const int minute = static_cast<int>(std::floor(second_of_day / 60.0));
  char time[32], second[64];
  std::snprintf(time, sizeof time, "T%02d:%02d:", minute / 60, minute % 60);
  const auto [end, code] =
      std::to_chars(second, second + sizeof second, second_of_day - 60.0 * minute, std::chars_format::fixed);
  if (code != std::errc()) return local_time_text(utc_s, offset_minutes);
  return date_text(date_of_day(day)) + time + std::string(second, end) + offset_text(offset_minutes);
}

}  // namespace sunfleck
