// What no weather does: the radiation of a row against what arrives outside the atmosphere.

#include <algorithm>
#include <cmath>

#include "lighting/sky/radiation_blocks.h"
#include "lighting/sky/radiation_split.h"
#include "lighting/sky/sun_day.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

// "it would fit as j_m2" if one of the other units brings the value to a share of the radiation outside the
// atmosphere that weather can leave; else nothing.
std::string fitting_unit(const RadiationTable& table, double ratio) {
  struct Candidate {
    const char* text;
    double factor;
  };
  std::string fits;
  if (table.is_power) return "check the unit";
  for (const Candidate& c : {Candidate{"MJ m-2", 1e6},
                             {"kWh m-2", 3.6e6},
                             {"J cm-2", 1e4},
                             {"Wh m-2", 3600.0},
                             {"kJ m-2", 1e3},
                             {"J m-2", 1.0}}) {
    const double share = ratio * c.factor / table.unit_in_si;
    if (share > 0.15 && share < 0.85) fits += (fits.empty() ? "" : " or ") + std::string(c.text);
  }
  return fits.empty() ? "check the unit" : "the numbers would fit as " + fits;
}

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

// Twilight, and what a horizontal sensor errs.
constexpr double kDarkOffsetWM2 = 3.0;

double most_possible_j_m2(const RadiationBlock& block, const BlockSun& sun, RadiationPer per) {
  if (per != RadiationPer::kTime)
    return sun.extraterrestrial_j_m2 + kDarkOffsetWM2 * (block.end_s - block.begin_s);
  double sum = 0;
  for (const SunPosition& s : sun.sun)
    sum += sun.step_s * most_global_horizontal_w_m2(extraterrestrial_normal_w_m2(s), std::cos(s.zenith_rad));
  return sum;
}

}  // namespace

void check_not_too_much(const RadiationBlock& block, const BlockSun& sun, const RadiationTable& table) {
  const double most = most_possible_j_m2(block, sun, table.per);
  if (block.global_j_m2 <= most) return;
  const double seconds = block.end_s - block.begin_s;
  const bool dark = sun.extraterrestrial_j_m2 <= 0.01 * seconds;
  if (dark)
    throw_invalid(block.row->where,
                  rounded(block.global_j_m2 / seconds) + " W m-2 arrive while the sun is down",
                  "check place, dates and time zone of the table");
  throw_invalid(block.row->where,
                "is " + rounded(block.global_j_m2 / sun.extraterrestrial_j_m2) +
                    " times what arrives outside the atmosphere (" +
                    rounded(sun.extraterrestrial_j_m2 * 1e-6) + " MJ m-2)",
                fitting_unit(table, block.global_j_m2 / sun.extraterrestrial_j_m2));
}

void check_not_too_little(double global_j_m2, double extraterrestrial_j_m2, double days,
                          const RadiationTable& table) {
  // The cloudiest climates leave a quarter over a year, a tenth over a winter month.
  const double least = days >= 300 ? 0.2 : 0.08;
  if (days < 20 || !(extraterrestrial_j_m2 > 0.0) || global_j_m2 >= least * extraterrestrial_j_m2) return;
  throw_invalid(table.name + ", column global_horizontal_" + table.unit,
                "adds up to " + rounded(100 * global_j_m2 / extraterrestrial_j_m2) +
                    " % of what arrives outside the atmosphere, darker than any climate",
                fitting_unit(table, global_j_m2 / extraterrestrial_j_m2));
}

}  // namespace sunfleck
