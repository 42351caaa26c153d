#include "lighting/sky/radiation_split.h"

#include <algorithm>
#include <cmath>

#include "sim/base/vec.h"

namespace sunfleck {
namespace {

constexpr double kWinterSunsetRad = radians_from_degrees(81.4);  // [Erbs82]: shorter days are "winter"

}  // namespace

// [Erbs82] Eq. 1.
double hourly_diffuse_fraction(double clearness_index) {
  const double k = std::clamp(clearness_index, 0.0, 1.0);
  if (k <= 0.22) return 1.0 - 0.09 * k;
  if (k <= 0.80) return 0.9511 + k * (-0.1604 + k * (4.388 + k * (-16.638 + k * 12.336)));
  return 0.165;
}

double daily_diffuse_fraction(double clearness_index, double sunset_hour_angle_rad) {
  const double k = std::clamp(clearness_index, 0.0, 1.0);
  if (sunset_hour_angle_rad <= kWinterSunsetRad)
    return k < 0.715 ? 1.0 + k * (-0.2727 + k * (2.4495 + k * (-11.9514 + k * 9.3879))) : 0.143;
  // The summer curve rises to 1.008 at k = 0.06: there all is diffuse.
  return k < 0.722 ? std::min(1.0, 1.0 + k * (0.2832 + k * (-2.5557 + k * 0.8448))) : 0.175;
}

double monthly_diffuse_fraction(double clearness_index, double sunset_hour_angle_rad) {
  const double k = std::clamp(clearness_index, 0.3, 0.8);
  if (sunset_hour_angle_rad <= kWinterSunsetRad) return 1.391 + k * (-3.560 + k * (4.189 - k * 2.137));
  return 1.311 + k * (-3.022 + k * (3.427 - k * 1.821));
}

double hourly_global_shape(double hour_angle_rad, double sunset_hour_angle_rad) {
  const double s = std::sin(sunset_hour_angle_rad - kPi / 3.0);
  return std::max(0.0, 0.409 + 0.5016 * s + (0.6609 - 0.4767 * s) * std::cos(hour_angle_rad));
}

double most_beam_normal_w_m2(double extraterrestrial_normal_w_m2, double cos_zenith) {
  return cos_zenith > 0.0 ? 0.95 * extraterrestrial_normal_w_m2 * std::pow(cos_zenith, 0.2) + 10.0 : 0.0;
}

double most_global_horizontal_w_m2(double extraterrestrial_normal_w_m2, double cos_zenith) {
  return 1.5 * extraterrestrial_normal_w_m2 * std::pow(std::max(cos_zenith, 0.0), 1.2) + 100.0;
}

double sunset_hour_angle_rad(double latitude_rad, double declination_rad) {
  return std::acos(std::clamp(-std::tan(latitude_rad) * std::tan(declination_rad), -1.0, 1.0));
}

}  // namespace sunfleck
