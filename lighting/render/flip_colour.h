// Colour spaces of FLIP. Private to the folder.
#pragma once

#include <cmath>

#include "sim/base/vec.h"

namespace sunfleck {

// Of linear sRGB (IEC 61966-2-1), white (D65) at X, Y, Z = kWhite.
inline const Vec3 kWhite{0.4124564 + 0.3575761 + 0.1804375, 1.0, 0.0193339 + 0.1191920 + 0.9503041};

inline Vec3 xyz_from_rgb(const Vec3& c) {
  return {0.4124564 * c.x + 0.3575761 * c.y + 0.1804375 * c.z,
          0.2126729 * c.x + 0.7151522 * c.y + 0.0721749 * c.z,
          0.0193339 * c.x + 0.1191920 * c.y + 0.9503041 * c.z};
}

inline Vec3 rgb_from_xyz(const Vec3& c) {
  return {3.2404542 * c.x - 1.5371385 * c.y - 0.4985314 * c.z,
          -0.9692660 * c.x + 1.8760108 * c.y + 0.0415560 * c.z,
          0.0556434 * c.x - 0.2040259 * c.y + 1.0572252 * c.z};
}

// Linear opponent space (YyCxCz): CIELAB without its cube roots.
inline Vec3 opponent_from_rgb(const Vec3& rgb) {
  const Vec3 c = xyz_from_rgb(rgb) / kWhite;
  return {116 * c.y - 16, 500 * (c.x - c.y), 200 * (c.y - c.z)};
}

inline Vec3 rgb_from_opponent(const Vec3& o) {
  const double y = (o.x + 16) / 116;
  return rgb_from_xyz(Vec3(y + o.y / 500, y, y - o.z / 200) * kWhite);
}

// CIELAB with a* and b* times L* / 100: colours of dark places differ less (Hunt effect).
inline Vec3 hunt_lab_from_rgb(const Vec3& rgb) {
  const auto f = [](double t) {
    constexpr double d = 6.0 / 29;
    return t > d * d * d ? std::cbrt(t) : t / (3 * d * d) + 4.0 / 29;
  };
  const Vec3 c = xyz_from_rgb(rgb) / kWhite;
  const double lightness = 116 * f(c.y) - 16;
  return {lightness, 0.01 * lightness * 500 * (f(c.x) - f(c.y)), 0.01 * lightness * 200 * (f(c.y) - f(c.z))};
}

inline double hyab(const Vec3& a, const Vec3& b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

}  // namespace sunfleck
