#include "lighting/shade/bough_table.h"

#include <algorithm>
#include <cmath>

#include "sim/base/error.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

// Two neighbouring rows and the share of the second.
struct Between {
  std::size_t first = 0;
  double share = 0;
};

Between between_rows(double position, int rows) {
  const double clamped = std::clamp(position, 0.0, rows - 1.0);
  const std::size_t first = std::min(static_cast<std::size_t>(clamped), static_cast<std::size_t>(rows - 2));
  return {first, clamped - static_cast<double>(first)};
}

Between zenith_rows(const Vec3& d, int rows) { return between_rows(zenith_of(d) / kPi * rows - 0.5, rows); }

double azimuth_between(const Vec3& a, const Vec3& b) {
  return std::abs(std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y));
}

Vec3 direction(double zenith, double azimuth) {
  return {std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)};
}

}  // namespace

BoughTable::BoughTable(int rows, const Source& source, const RunControl& control) : rows_(rows) {
  if (rows < 2 || rows > 64) throw_invalid("bough table rows", std::to_string(rows), "2 to 64");
  const auto n = static_cast<std::size_t>(rows);
  opacity_.assign(n, 0);
  reflected_.assign(n * n * n, 0);
  const double step = kPi / rows;
  for_each_chunk(n * n, 1, control, "", [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (std::size_t k = 0; k < n; ++k) {
        const double view = (static_cast<double>(row / n) + 0.5) * step;
        const double light = (static_cast<double>(row % n) + 0.5) * step;
        const double azimuth = kPi * static_cast<double>(k) / (rows - 1);
        const BoughLight value = source(direction(view, 0), direction(light, azimuth));
        reflected_[row * n + k] = static_cast<float>(value.reflected);
        if (row % n == 0 && k == 0) opacity_[row / n] = static_cast<float>(value.opacity);
      }
  });
}

BoughLight BoughTable::at(const Vec3& to_viewer, const Vec3& to_light) const {
  const auto n = static_cast<std::size_t>(rows_);
  const Between view = zenith_rows(to_viewer, rows_), light = zenith_rows(to_light, rows_);
  const Between azimuth = between_rows(azimuth_between(to_viewer, to_light) / kPi * (rows_ - 1), rows_);
  const auto mix = [](double a, double b, double share) { return a + (b - a) * share; };
  const auto along_azimuth = [&](std::size_t i, std::size_t j) {
    const float* row = &reflected_[(i * n + j) * n + azimuth.first];
    return mix(row[0], row[1], azimuth.share);
  };
  const auto along_light = [&](std::size_t i) {
    return mix(along_azimuth(i, light.first), along_azimuth(i, light.first + 1), light.share);
  };
  return {mix(opacity_[view.first], opacity_[view.first + 1], view.share),
          mix(along_light(view.first), along_light(view.first + 1), view.share)};
}

}  // namespace sunfleck
