// Radiation tables: CSV files of measured global radiation by month, day or hour.
//
// What each row is about, one of
//   month            1 to 12, for every year, or for one year with a second column `year`
//   date             2024-06-21: a day of the local clock (the offset of the period asked for)
//   time             2024-06-21T13:00+01:00: begin of the row, with time zone; a row lasts until the next one
//                    (the shortest distance between rows; 1 minute to 3 hours)
// How much, one of (u: mj_m2, kj_m2, j_m2, kwh_m2, wh_m2 summed over the row, or w_m2 as the row's mean)
//   global_horizontal_<u>
// and, if known, one of
//   diffuse_fraction       diffuse / global on the horizontal, [0, 1]
//   diffuse_horizontal_<u> at most the global radiation
// Other columns are ignored. Without a diffuse column the share is estimated (radiation_split.h).
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sunfleck {

enum class RadiationPer { kMonth, kDay, kTime };

struct RadiationRow {
  int year = 0;                   // kMonth: 0 is every year
  int month = 0;                  // kMonth: 1 to 12
  int day = 0;                    // kDay: days since 2000-01-01
  double begin_s = 0, end_s = 0;  // kTime: seconds since 2000-01-01T00:00 UTC
  double global = 0;              // J m-2, or W m-2 where the table is one of power
  std::optional<double> diffuse_fraction;
  std::string where;  // "file:line, column x", for messages
};

struct RadiationTable {
  std::string name;
  RadiationPer per = RadiationPer::kMonth;
  bool is_power = false;           // `global` is a mean in W m-2
  std::string unit;                // as in the column's name: "mj_m2"
  double unit_in_si = 1;           // J m-2 or W m-2 per unit
  std::vector<RadiationRow> rows;  // in the order of time
};

// Throw Error(kInvalidInput) at "name:line, column x": columns missing, doubled or of an unknown unit, what
// is no number, negative or not finite, a share outside [0, 1], more diffuse than global, no such month or
// date, a time without time zone, two rows for one month, day or time, rows that overlap. kNotFound: no such
// file.
RadiationTable parse_radiation(std::string_view csv, const std::string& name);
RadiationTable read_radiation(const std::filesystem::path& path);

// For rows from anywhere else than CSV: put in the order of time, ends of kTime rows set. The same errors, at
// the rows' own `where`; no rows: at `name`.
RadiationTable radiation_table(const std::string& name, RadiationPer per, bool is_power,
                               std::vector<RadiationRow> rows);

}  // namespace sunfleck
