#include "lighting/sky/radiation_blocks.h"

#include <algorithm>
#include <cmath>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

[[noreturn]] void throw_lacking(const RadiationTable& table, const std::string& what) {
  throw_invalid(table.name, "the table has no row for " + what,
                "a row for every month, day or time of the period, or a period within the table");
}

const RadiationRow* find_month(const RadiationTable& table, int year, int month) {
  const RadiationRow* every_year = nullptr;
  for (const RadiationRow& row : table.rows) {
    if (row.month != month) continue;
    if (row.year == year) return &row;
    if (row.year == 0) every_year = &row;
  }
  return every_year;
}

RadiationBlock block_of(const RadiationTable& table, const RadiationRow& row, double begin_s, double end_s) {
  return {begin_s, end_s, table.is_power ? row.global * (end_s - begin_s) : row.global, &row};
}

std::vector<RadiationBlock> month_blocks(const RadiationTable& table, const TimeSpan& period) {
  std::vector<RadiationBlock> blocks;
  CivilDate date = date_of_day(local_day(period.begin_s, period.offset_minutes));
  date.day = 1;
  double begin_s = day_begin_s(day_number(date), period.offset_minutes);
  while (begin_s < period.end_s) {
    const RadiationRow* row = find_month(table, date.year, date.month);
    if (!row) throw_lacking(table, date_text(date).substr(0, 7));
    date = date.month == 12 ? CivilDate{date.year + 1, 1, 1} : CivilDate{date.year, date.month + 1, 1};
    const double end_s = day_begin_s(day_number(date), period.offset_minutes);
    blocks.push_back(block_of(table, *row, begin_s, end_s));
    begin_s = end_s;
  }
  return blocks;
}

std::vector<RadiationBlock> day_blocks(const RadiationTable& table, const TimeSpan& period) {
  std::vector<RadiationBlock> blocks;
  for (int day = local_day(period.begin_s, period.offset_minutes);; ++day) {
    const double begin_s = day_begin_s(day, period.offset_minutes);
    if (begin_s >= period.end_s) return blocks;
    const auto row = std::lower_bound(table.rows.begin(), table.rows.end(), day,
                                      [](const RadiationRow& r, int d) { return r.day < d; });
    if (row == table.rows.end() || row->day != day) throw_lacking(table, date_text(date_of_day(day)));
    blocks.push_back(block_of(table, *row, begin_s, begin_s + 86400.0));
  }
}

std::vector<RadiationBlock> time_blocks(const RadiationTable& table, const TimeSpan& period) {
  constexpr double kSlackS = 1e-3;
  std::vector<RadiationBlock> blocks;
  double covered_s = period.begin_s;
  for (const RadiationRow& row : table.rows) {
    if (row.end_s <= covered_s + kSlackS) continue;
    if (covered_s + kSlackS >= period.end_s) break;
    if (row.begin_s > covered_s + kSlackS) break;
    blocks.push_back(block_of(table, row, row.begin_s, row.end_s));
    covered_s = row.end_s;
  }
  if (covered_s + kSlackS < period.end_s)
    throw_lacking(table, local_time_text(covered_s, period.offset_minutes));
  return blocks;
}

}  // namespace

std::vector<RadiationBlock> blocks_of(const RadiationTable& table, const TimeSpan& period) {
  switch (table.per) {
    case RadiationPer::kMonth:
      return month_blocks(table, period);
    case RadiationPer::kDay:
      return day_blocks(table, period);
    case RadiationPer::kTime:
      break;
  }
  return time_blocks(table, period);
}

}  // namespace sunfleck
