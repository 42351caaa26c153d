// Radiation tables in stand_request.h.
#include "lighting/sky/utc_time.h"
#include "server/convert/stand_request.h"
#include "sunfleck/v1/stand_light.pb.h"

namespace sunfleck {
namespace {

constexpr double kMost_j_m2 = 1e15;

void add(const Error& error, Violations& violations) {
  Violation violation = violation_of(error);
  violations.add(std::move(violation.field), std::move(violation.description));
}

RadiationPer per_of(const v1::RadiationRow& row) {
  if (!row.date().empty()) return RadiationPer::kDay;
  return row.time().empty() ? RadiationPer::kMonth : RadiationPer::kTime;
}

void read_time(const v1::RadiationRow& message, const std::string& field, RadiationPer per,
               Violations& violations, RadiationRow& row) {
  const int times = (message.month() != 0) + !message.date().empty() + !message.time().empty();
  if (times != 1 || per_of(message) != per)
    return violations.add(field, "must have one of month, date and time, the same as in the other rows");
  try {
    if (per == RadiationPer::kDay) row.day = day_number(parse_date(message.date(), field + ".date"));
    if (per == RadiationPer::kTime) row.begin_s = parse_zoned_time(message.time(), field + ".time").utc_s;
  } catch (const Error& error) {
    add(error, violations);
  }
  if (per != RadiationPer::kMonth) return;
  row.month = message.month();
  row.year = message.year();
  violations.integer(field + ".month", row.month, 1, 12);
  if (row.year != 0) violations.integer(field + ".year", row.year, 1900, 2100);
}

RadiationRow read_row(const v1::RadiationRow& message, const std::string& field, RadiationPer per,
                      bool is_power, Violations& violations) {
  RadiationRow row;
  row.where = field;
  read_time(message, field, per, violations, row);
  row.global = is_power ? message.global_horizontal_w_m2() : message.global_horizontal_j_m2();
  const bool given = is_power ? message.has_global_horizontal_w_m2() : message.has_global_horizontal_j_m2();
  const std::string name = is_power ? ".global_horizontal_w_m2" : ".global_horizontal_j_m2";
  if (!given)
    violations.add(field + name, "must be given, the same kind in all rows");
  else
    violations.number(field + name, row.global, 0, kMost_j_m2);
  if (!message.has_diffuse_fraction()) return row;
  row.diffuse_fraction = message.diffuse_fraction();
  violations.number(field + ".diffuse_fraction", *row.diffuse_fraction, 0, 1);
  return row;
}

void fill_row(const RadiationRow& row, const RadiationTable& table, v1::RadiationRow& message) {
  switch (table.per) {
    case RadiationPer::kMonth:
      message.set_month(row.month);
      message.set_year(row.year);
      break;
    case RadiationPer::kDay:
      message.set_date(date_text(date_of_day(row.day)));
      break;
    case RadiationPer::kTime:
      message.set_time(exact_time_text(row.begin_s, 0));
      break;
  }
  if (table.is_power)
    message.set_global_horizontal_w_m2(row.global);
  else
    message.set_global_horizontal_j_m2(row.global);
  if (row.diffuse_fraction) message.set_diffuse_fraction(*row.diffuse_fraction);
}

}  // namespace

RadiationTable radiation_from_message(const v1::RadiationTable& message, const std::string& field,
                                      Violations& violations) {
  const bool one_of_both = (message.rows_size() > 0) != !message.csv().empty();
  if (!one_of_both) {
    violations.add(field, "must have either `rows` or `csv`");
    return {};
  }
  try {
    if (!message.csv().empty()) return parse_radiation(message.csv(), field + ".csv");
    const RadiationPer per = per_of(message.rows(0));
    const bool is_power = message.rows(0).has_global_horizontal_w_m2();
    const std::size_t before = violations.all().size();
    std::vector<RadiationRow> rows;
    for (int i = 0; i < message.rows_size(); ++i) {
      const std::string row = at(field + ".rows", static_cast<std::size_t>(i));
      rows.push_back(read_row(message.rows(i), row, per, is_power, violations));
    }
    if (violations.all().size() > before) return {};
    return radiation_table(field, per, is_power, std::move(rows));
  } catch (const Error& error) {
    add(error, violations);
  }
  return {};
}

void fill_message(const RadiationTable& table, const std::string& name, v1::RadiationTable& message) {
  message.set_name(name);
  for (const RadiationRow& row : table.rows) fill_row(row, table, *message.add_rows());
}

}  // namespace sunfleck
